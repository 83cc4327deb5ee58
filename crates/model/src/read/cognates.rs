//! Studies that ask how else a coupler curve is traced.
//!
//! ```toml
//! [studies.others]
//! kind     = "synthesize"
//! task     = "cognates"
//! point    = "P"
//! parallel = true
//! ```

use crate::read::choices::drive_named;
use crate::read::context::Context;
use crate::read::dwell::moving_point;
use crate::read::entry::Entry;
use crate::synthesis::CognatesTask;

pub(crate) fn read(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<CognatesTask> {
    let point = moving_point(
        cx,
        entry,
        "name a point of a coupler, whose curve others can trace",
    );
    let drive = drive_named(cx, entry);
    let parallel = entry.flag(cx, "parallel");
    let (point, span) = point?;
    Some(CognatesTask {
        point,
        drive: drive?.0,
        parallel: parallel?,
        span,
    })
}
