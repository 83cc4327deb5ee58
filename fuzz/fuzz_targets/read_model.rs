//! Any bytes: a model that can be evaluated, or diagnostics whose places lie in the text.
#![no_main]

use kempe_model::Model;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let files = &mut |_: &str| Ok(String::from_utf8_lossy(data).into_owned());
    let text = String::from_utf8_lossy(data);
    // Where no parameter `a` is, overriding it is an error before anything else is read: most inputs override nothing.
    let overrides = [("a".to_owned(), "25 mm".to_owned())];
    let given = if data.len().is_multiple_of(5) { &overrides[..] } else { &[] };
    match Model::from_bytes(data, "fuzz", files, given) {
        Ok(checked) => {
            let values: Vec<f64> = checked.model.parameter_values();
            for link in &checked.model.links {
                assert_eq!(link.evaluate(&values).len(), link.points.len());
            }
            for drive in &checked.model.drives {
                assert!(drive.law.at(drive.law.duration(&values), &values).is_finite());
            }
            let file = checked.model.to_toml();
            let _ = Model::from_toml(&file.toml, "written", &mut file.tables.files());
        }
        Err(found) => {
            assert!(!found.is_empty());
            for d in &found {
                d.render_plain("fuzz", &text);
            }
        }
    }
});
