//! Plots of columns: own axes with round ticks, gaps where a row was not reached, markers at dead and change points.

mod axis;
mod curve;
mod draw;
mod frame;
mod hodograph;
mod limit;
mod spec;

pub use axis::{Axis, Scale};
pub(crate) use curve::thinned;
pub use curve::{Curve, Told};
pub use draw::PlotPicture;
pub use limit::{Beyond, Limit, LimitLine};
pub use spec::{Hodograph, Marker, MarkerKind, PlotSpec};
