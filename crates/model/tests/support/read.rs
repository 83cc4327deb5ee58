//! Models from texts.

use kempe_model::Model;

/// The model of a text; what is wrong with it is told.
pub fn read(text: &str) -> Model {
    match Model::from_toml(text, "test", &mut |name| Err(format!("no {name}"))) {
        Ok(checked) => checked.model,
        Err(found) => panic!(
            "{}",
            found
                .iter()
                .map(|d| d.render_plain("test", text))
                .collect::<String>()
        ),
    }
}
