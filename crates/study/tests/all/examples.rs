//! Every example runs: all rows reached, loops closed, a report made of it.

use std::fs;
use std::path::{Path, PathBuf};

use kempe_model::{Model, Severity};
use kempe_study::{ReportOrigin, Silent, StudyOutcome, check, encode, report, run};

/// Difference of virtual power and equilibrium that no example exceeds.
const ROUTES_AGREE: f64 = 1e-9;

fn examples() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    let folders = ["seeds", "gallery"].map(|f| root.join(f));
    let entries = folders
        .iter()
        .flat_map(|f| fs::read_dir(f).expect("examples"));
    let mut files: Vec<PathBuf> = entries
        .map(|e| e.expect("an entry").path())
        .filter(|p| p.extension().is_some_and(|e| e == "toml"))
        .collect();
    files.sort();
    files
}

#[test]
fn every_example_runs() {
    let mut diagnostic = Vec::new();
    for path in examples() {
        let name = path.display().to_string();
        let text = fs::read_to_string(&path).expect("text");
        let folder = path.parent().expect("a folder");
        let mut files =
            |file: &str| fs::read_to_string(folder.join(file)).map_err(|e| e.to_string());
        let checked = match Model::from_toml(&text, &name, &mut files) {
            Ok(checked) => checked,
            Err(found) => {
                diagnostic.extend(found.iter().map(|d| d.render_plain(&name, &text)));
                continue;
            }
        };
        let model = checked.model;
        let findings = check(&model);
        let errors = findings
            .diagnostics
            .iter()
            .filter(|d| d.severity == Severity::Error);
        diagnostic.extend(errors.map(|d| d.render_plain(&name, &text)));
        let mut outcomes = Vec::new();
        for study in &model.studies {
            let result = run(&model, study, &mut Silent);
            match &result {
                Ok(result) => {
                    let table = &result.table;
                    let closed = table.worst_closure() < 1e-10;
                    // Around the change point of the lock no contact settles.
                    let lock = name.ends_with("door-lock.toml") && study.name == "play";
                    if (table.unreached() > 0) != lock || table.rows() == 0 || !closed {
                        diagnostic.push(format!("{name}: {:?}", table.noted().first()));
                    }
                    if let Some((row, difference)) = table.worst_route_difference()
                        && !(difference < ROUTES_AGREE)
                    {
                        diagnostic.push(format!(
                            "{name}: routes differ by {difference:.1e} in row {row}"
                        ));
                    }
                    assert_eq!(
                        encode::csv(table).lines().count(),
                        table.rows() + 1,
                        "{name}"
                    );
                }
                Err(found) => diagnostic.extend(found.iter().map(|d| d.render_plain(&name, &text))),
            }
            outcomes.push(StudyOutcome { study, result });
        }
        let html = report(
            &model,
            &ReportOrigin {
                file_name: &name,
                text: &text,
                ..ReportOrigin::default()
            },
            &checked.warnings,
            &findings,
            &outcomes,
            None,
        )
        .to_html();
        assert!(html.contains("</html>"), "{name}");
    }
    assert!(diagnostic.is_empty(), "{}", diagnostic.join("\n"));
}
