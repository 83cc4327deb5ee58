//! What the files of a run are called, so that no two files of a model have one name.

use kempe_model::Model;

/// The file name of a picture of a study: `turn-swing.svg`.
///
/// Where that might as well be a picture of another study whose name goes on with a hyphen, as `b` of `turn-a` and `a-b` of
/// `turn`, the shorter study's is set off by a dot: `turn.a-b.svg`. Neither studies nor pictures have a dot in their names.
/// Only the model decides, so that a run of some of its studies leaves the files of others alone.
pub fn picture(model: &Model, study: &str, picture: &str) -> String {
    let name = format!("{study}-{picture}").to_lowercase();
    let may_be_of = |other: &str| {
        let start = format!("{}-", other.to_lowercase());
        other.len() > study.len() && name.starts_with(&start)
    };
    let mut known = model.studies.iter().map(|s| s.name.as_str());
    let mark = match known.any(may_be_of) {
        true => '.',
        false => '-',
    };
    format!("{study}{mark}{picture}.svg")
}

/// The name of a file of a mechanism that a study found, in the study's folder: `generator/01.toml`.
pub fn design(study: &str, file: &str) -> String {
    format!("{study}/{file}")
}

/// The name of a file with the rows of all designs of a sweep: `family.rows.parquet`, or, of several, `family.rows-01.parquet` and so on. No
/// study has a dot in its name.
pub fn rows(study: &str, file: usize, of: usize) -> String {
    match of {
        1 => format!("{study}.rows.parquet"),
        _ => format!("{study}.rows-{:02}.parquet", file + 1),
    }
}

/// The name of a file of the other one of two designs: `turn.against.csv`. No study has a dot in its name.
pub fn of_other_design(name: &str) -> String {
    match name.rsplit_once('.') {
        Some((stem, ending)) => format!("{stem}.against.{ending}"),
        None => format!("{name}.against"),
    }
}

/// The name of the table that sets two designs beside each other: `comparison.csv`, unless that is the table of a study.
pub fn comparison(model: &Model) -> &'static str {
    let mut names = model.studies.iter().map(|s| s.name.as_str());
    match names.any(|name| name.to_lowercase() == "comparison") {
        true => "report.comparison.csv",
        false => "comparison.csv",
    }
}

/// The name of a file of a run: of one that was stopped, `turn.csv` is `turn.partial.csv`.
pub fn of_run(name: &str, partial: bool) -> String {
    match name.rsplit_once('.') {
        // What a study had found by then stands in a folder of its own, so that files that name each other find each other.
        _ if partial && name.contains('/') => name.replacen('/', ".partial/", 1),
        Some((stem, ending)) if partial => format!("{stem}.partial.{ending}"),
        _ => name.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_comparison_is_no_table_of_a_study() {
        let of = |study: &str| {
            let text = format!(
                "[links]\nframe = {{ A = [0, 0] }}\ncrank = {{ A-B = 1 }}\n[drives]\nmotor = {{ turns = \"crank\", speed = 1 }}\n\
                 [studies.{study}]\nkind = \"motion\"\n"
            );
            let model = Model::from_toml(&text, "x", &mut |_| Err(String::new()));
            comparison(&model.expect("a model").model)
        };
        assert_eq!(of("turn"), "comparison.csv");
        assert_eq!(of("comparison"), "report.comparison.csv");
        assert_eq!(of_other_design("turn.csv"), "turn.against.csv");
    }

    #[test]
    fn studies_whose_names_go_on_keep_their_pictures_apart() {
        let text = "[links]\nframe = { A = [0, 0] }\ncrank = { A-B = 1 }\n[drives]\nmotor = { turns = \"crank\", speed = 1 }\n\
                    [studies.turn]\nkind = \"motion\"\n[studies.turn-a]\nkind = \"motion\"\n[studies.turn-a-b]\nkind = \"motion\"\n";
        let model = Model::from_toml(text, "x", &mut |_| Err(String::new()));
        let model = model.expect("a model").model;
        for (study, plot, file) in [
            ("turn", "swing", "turn-swing.svg"),
            ("turn", "a", "turn-a.svg"),
            ("turn", "a-b", "turn.a-b.svg"),
            ("turn", "A-B", "turn.A-B.svg"),
            ("turn-a", "b", "turn-a-b.svg"),
            ("turn-a", "b-c", "turn-a.b-c.svg"),
            ("turn-a-b", "c", "turn-a-b-c.svg"),
        ] {
            assert_eq!(picture(&model, study, plot), file);
        }
    }
}
