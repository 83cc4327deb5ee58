//! The goal that stands for a fit.

use kempe_model::{Goal, OptimizeStudy};
use kempe_units::{Dimension, Expr};

/// What is told of a fit in place of a goal.
pub(super) const SQUARES: &str = "sum of squares";

/// The study with a goal that stands for its fit: other rooms tell of goals. Its value is that of the fit.
pub(in super::super) fn with_goal(study: &OptimizeStudy) -> OptimizeStudy {
    let mut study = study.clone();
    if let Some(fit) = &study.fit {
        study.goals = vec![Goal {
            number: kempe_model::Column {
                name: SQUARES.to_owned(),
                measure: Expr::Const(0.0),
                dimension: Dimension::AREA,
            },
            maximize: false,
            span: fit.span.clone(),
        }];
    }
    study
}
