//! What a study plots besides the columns of its table, as columns: every curve has a name, a unit and numbers.

use kempe_draw::plot::{Curve, PlotSpec};
use kempe_model::Model;
use kempe_units::Unit;

use crate::figures::figures;
use crate::result::{Figure, StudyResult};
use crate::table::Column;

/// The plotted quantities that are no columns of the table, each once: curves, their limits, the coordinates of a point
/// whose path is plotted, the components of a joint's force.
pub(crate) fn plotted(model: &Model, result: &StudyResult) -> Vec<Column> {
    let mut more: Vec<Column> = Vec::new();
    let mut add = |column: Column| {
        let mut known = result.table.columns.iter().chain(&more);
        if !known.any(|c| c.name == column.name) {
            more.push(column);
        }
    };
    for figure in &result.figures {
        match figure {
            Figure::Curves { curves, limits } => {
                curves.iter().chain(limits).cloned().for_each(&mut add);
            }
            Figure::Within { curve, bound } => {
                [curve, bound].into_iter().cloned().for_each(&mut add)
            }
            Figure::Path(_)
            | Figure::Hodograph(..)
            | Figure::Plane { .. }
            | Figure::Graph { .. }
            | Figure::Front { .. }
            | Figure::Histogram { .. } => {}
        }
    }
    // A curve in the plane as it is plotted.
    let plots = result.figures.iter().zip(figures(model, result));
    for (figure, (_, plot)) in plots {
        let names = match figure {
            Figure::Curves { .. }
            | Figure::Within { .. }
            | Figure::Plane { .. }
            | Figure::Graph { .. }
            | Figure::Front { .. }
            | Figure::Histogram { .. } => continue,
            Figure::Path(point) => {
                let name = model.points.get(point.index()).map_or("", |p| &p.name);
                ["x", "y"].map(|axis| format!("{axis}({name})"))
            }
            // Axes that have names of their own are columns, as of an orbit.
            Figure::Hodograph(_, [x, y]) if x.name != y.name => {
                [&x.name, &y.name].map(String::clone)
            }
            Figure::Hodograph(name, _) => ["x", "y"].map(|axis| component(name, axis)),
        };
        if let Some(curve) = plot.curves.first() {
            coordinates(names, &plot, curve)
                .into_iter()
                .for_each(&mut add);
        }
    }
    more
}

/// `reaction_x(B)` of `hodograph(B)`, as the measure is called.
fn component(hodograph: &str, axis: &str) -> String {
    match hodograph.split_once('(') {
        Some((_, rest)) => format!("reaction_{axis}({rest}"),
        None => format!("{hodograph} {axis}"),
    }
}

/// The coordinates of a curve in the plane.
fn coordinates([x, y]: [String; 2], plot: &PlotSpec, curve: &Curve) -> [Column; 2] {
    let column = |name: String, unit: &str, values: &[f64]| Column {
        values: values.to_vec(),
        ..Column::new(name, Unit::parse(unit).unwrap_or_else(|_| Unit::one()))
    };
    [
        column(x, &plot.x.unit, &curve.x),
        column(y, &plot.y.unit, &curve.y),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Silent, run};

    fn columns(study: &str) -> (Vec<String>, StudyResult) {
        let text = format!(
            "units = {{ length = \"mm\", angle = \"deg\" }}\n[links]\nframe = {{ A = [0, 0], D = [60, 0] }}\n\
             crank = {{ A-B = 20, mass = 1 }}\ncoupler = {{ B-C = 50, mass = 1, inertia = 1 }}\nrocker = {{ D-C = 40 }}\n[drives]\n\
             motor = {{ turns = \"crank\", from = 0, to = 360, speed = \"1 rad/s\" }}\n[assembly]\n\
             C = \"left of B -> D\"\n{study}"
        );
        let checked = Model::from_toml(&text, "x", &mut |_| Err(String::new()));
        let model = checked.expect("a model").model;
        let result = run(&model, &model.studies[0], &mut Silent).expect("a result");
        let more = plotted(&model, &result);
        (more.iter().map(Column::head).collect(), result)
    }

    #[test]
    fn what_is_plotted_has_a_column() {
        let study = "[studies.turn]\nkind = \"motion\"\nrows = 7\ncolumns = [\"x(C)\"]\n\
                     plot = [\"path(C)\", \"path(B)\", \"rate(angle(rocker))\", \"x(C)\"]\n";
        let (more, result) = columns(study);
        let names = [
            "rate(angle(rocker)) [rad/s]",
            "y(C) [mm]",
            "x(B) [mm]",
            "y(B) [mm]",
        ];
        assert_eq!(more, names);
        assert!(result.table.column("x(C)").is_some());
    }

    #[test]
    fn an_orbit_is_told_by_the_columns_of_its_journal_alone() {
        let study = "[clearance]\nB = { radial = \"0.1 mm\", radius = 5, restitution = 0.5 }\n[studies.rattle]\nkind = \"clearance\"\n\
                     model = \"three-state\"\nuntil = \"2 ms\"\nrows = 5\ncolumns = [\"x(C)\"]\nplot = [\"x(C)\"]\n";
        let (more, result) = columns(study);
        assert_eq!(more, [""; 0]);
        assert!(
            result
                .figures
                .iter()
                .any(|f| matches!(f, Figure::Hodograph(name, _) if name == "orbit of B"))
        );
        assert!(
            ["B play x", "B play y"]
                .iter()
                .all(|name| result.table.column(name).is_some())
        );
    }

    #[test]
    fn the_components_of_a_force_are_named_as_measures_are() {
        assert_eq!(component("hodograph(B)", "x"), "reaction_x(B)");
        assert_eq!(
            component("hodograph(B, crank)", "y"),
            "reaction_y(B, crank)"
        );
    }
}
