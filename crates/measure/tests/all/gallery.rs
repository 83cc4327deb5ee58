//! Every example runs: it closes, covers the whole of its drive's range, on a known assembly.
#![allow(clippy::unwrap_used)]

use crate::support::{Case, spread};
use kempe_measure::Sampler;
use kempe_measure::measure::asks_unknown_state;
use kempe_model::Measure;
use kempe_motion::EndReason;
use kempe_motion::trace::Path;

#[test]
fn every_example_closes_over_its_whole_range() {
    let mut count = 0;
    for folder in ["gallery", "seeds"] {
        let root = format!("{}/../../examples/{folder}", env!("CARGO_MANIFEST_DIR"));
        let mut paths: Vec<_> = std::fs::read_dir(&root)
            .unwrap()
            .map(|entry| entry.unwrap().path())
            .filter(|path| path.extension().is_some_and(|e| e == "toml"))
            .collect();
        paths.sort();
        for path in paths {
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            let text = std::fs::read_to_string(&path).unwrap();
            let case = Case::read_with(&text, &name, &mut |file| {
                std::fs::read_to_string(format!("{root}/{file}")).map_err(|e| e.to_string())
            });
            // What asks for linkages has no mechanism of its own.
            if case.model.drives.is_empty() {
                continue;
            }
            let motion = case.must_move();
            assert_eq!(
                motion.ends,
                (EndReason::Covered, EndReason::Covered),
                "{name}"
            );
            assert!(!motion.assemblies.list.is_empty(), "{name}");
            let measures: Vec<&Measure> = (case.model.measures.iter())
                .filter(|m| !m.needs_forces && !asks_unknown_state(&case.model, &m.measure))
                .map(|m| &m.measure)
                .collect();
            let mut sampler = Sampler::new(&motion, &measures).unwrap();
            for p in spread(&motion, 25) {
                let row = sampler.at_parameter(p);
                assert!(row.closure < 1e-12, "{name} at {p}: {:e}", row.closure);
                assert_eq!(
                    bits(&sampler.values_at_parameter(p)),
                    bits(&row.values),
                    "{name} at {p}: values alone"
                );
                let label = row
                    .note
                    .as_ref()
                    .map_or_else(String::new, |note| note.text(motion.mechanism()));
                let fine = label.is_empty()
                    || label.starts_with("change point")
                    || label.starts_with("limit");
                assert!(fine, "{name} at {p}: {label}");
            }
            // Beyond the motion there is nothing to measure.
            let beyond = motion.reached().1 + motion.path.scale();
            let values = sampler.values_at_parameter(beyond);
            assert!(values.iter().all(|v| v.is_nan()), "{name}: {values:?}");
            count += 1;
        }
    }
    assert!(count >= 27, "{count} examples");
}

/// The bits of numbers; those that are none are all alike.
fn bits(values: &[f64]) -> Vec<u64> {
    let one = |v: &f64| if v.is_nan() { u64::MAX } else { v.to_bits() };
    values.iter().map(one).collect()
}
