//! Drawings of planar linkages from plain data: poses, animations, plots, CAD exchange and a self-contained report.
//!
//! Nothing is computed here: whoever knows the mechanism fills a [`MechanismView`] and its [`Frame`]s (SI units), and
//! gets pictures back. The same input gives the same bytes.
//!
//! ```
//! use kempe_draw::*;
//! let view = MechanismView {
//!     title: "Crank".into(),
//!     length_unit: LengthUnit::new("mm", 1e-3),
//!     load_units: LoadUnits::default(),
//!     points: vec!["A".into(), "B".into()],
//!     links: vec![
//!         LinkView { name: "frame".into(), points: vec![0] },
//!         LinkView { name: "crank".into(), points: vec![0, 1] },
//!     ],
//!     joints: vec![],
//!     traces: vec![],
//!     drives: vec![],
//!     dimensions: vec![],
//! };
//! let pose = Frame { points: vec![[0.0, 0.0], [0.0, 0.05]], links: vec![[0.0; 3], [0.0; 3]], ..Frame::default() };
//! let poses = [pose];
//! let stage = Stage::new(&view, &poses, DrawOptions::default());
//! let picture = svg::document(&stage.scene(0), Theme::Light);
//! assert!(picture.starts_with("<svg"));
//! ```

mod context;
mod dimensions;
pub mod dxf;
mod escape;
mod fit;
mod furniture;
mod ghost;
mod hull;
mod labelled;
mod labels;
mod loads;
mod picture;
pub mod plot;
#[cfg(feature = "raster")]
pub mod raster;
pub mod report;
mod roles;
pub mod scene;
mod stage;
pub mod svg;
mod symbols;
mod text;
pub mod tokens;
mod trace;
mod view;

pub use context::Anchor;
pub use ghost::Outline;
pub use loads::{LoadRole, LoadView};
pub use stage::{DrawOptions, Stage};
pub use tokens::Theme;
pub use view::{
    ArcGuide, CurveGuide, DimensionKind, DimensionView, DriveKind, DriveView, Frame, Guide,
    JointView, LengthUnit, LinkView, LoadUnit, LoadUnits, MechanismView, TraceView, Wheel,
};
