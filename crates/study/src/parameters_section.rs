//! The parameters of a model in its report: their values, and which of them were set for the run.

use kempe_draw::report::{Block, Section};
use kempe_model::Model;

use crate::report_origin::ReportOrigin;
use crate::unit::Units;

/// The parameters with their values; `None` where the model has none.
pub(crate) fn parameters_section(model: &Model, origin: &ReportOrigin<'_>) -> Option<Section> {
    if model.parameters.is_empty() {
        return None;
    }
    let units = Units::of(model);
    let given = |name: &str| origin.set.iter().find(|(set, _)| set == name);
    let mut head = vec![
        "Parameter".to_owned(),
        "Value".to_owned(),
        "In the file".to_owned(),
    ];
    let any = model.parameters.iter().any(|p| given(&p.name).is_some());
    if any {
        head.push("Set for this run".to_owned());
    }
    let values = model.parameter_values();
    let row = |(parameter, value): (&kempe_model::Parameter, f64)| {
        let in_file = origin.text.get(parameter.span.clone()).unwrap_or("");
        let mut row = vec![
            parameter.name.clone(),
            units.text(value, parameter.dimension),
            in_file.trim_matches(['"', '\'']).to_owned(),
        ];
        if any {
            let set = given(&parameter.name);
            row.push(set.map_or(String::new(), |(name, text)| format!("--set {name}={text}")));
        }
        row
    };
    Some(Section {
        title: "Parameters".to_owned(),
        blocks: vec![Block::Table {
            head,
            rows: model.parameters.iter().zip(values).map(row).collect(),
        }],
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "units = { length = \"mm\", angle = \"deg\" }\n[parameters]\na = \"20 mm\"\nb = \"2*a\"\nn = 3\n\
                        [links]\nframe = { A = [0, 0] }\ncrank = { A-B = \"b\" }\n";

    fn rows(set: &[(String, String)]) -> Vec<Vec<String>> {
        let model = Model::from_bytes(TEXT.as_bytes(), "x", &mut |_| Err(String::new()), set);
        let origin = ReportOrigin {
            text: TEXT,
            set,
            ..ReportOrigin::default()
        };
        let section = parameters_section(&model.expect("a model").model, &origin);
        match section.expect("a section").blocks.pop() {
            Some(Block::Table { rows, .. }) => rows,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn values_are_told_with_their_units_and_what_was_set_is_marked() {
        assert_eq!(
            rows(&[]),
            [
                ["a", "20 mm", "20 mm"],
                ["b", "40 mm", "2*a"],
                ["n", "3", "3"]
            ]
        );
        let set = [("a".to_owned(), "1in".to_owned())];
        assert_eq!(
            rows(&set),
            [
                ["a", "25.4 mm", "20 mm", "--set a=1in"],
                ["b", "50.8 mm", "2*a", ""],
                ["n", "3", "3", ""]
            ]
        );
    }
}
