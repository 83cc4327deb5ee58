//! The models of the examples.

use std::fs;
use std::path::Path;

use kempe_model::Model;

/// Every example that reads, by the name of its file, in order.
pub fn examples() -> Vec<(String, Model)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    let folders = ["seeds", "gallery"].map(|f| fs::read_dir(root.join(f)).expect("a folder"));
    let files = folders
        .into_iter()
        .flatten()
        .map(|e| e.expect("an entry").path());
    let mut files: Vec<_> = files
        .filter(|path| path.extension().is_some_and(|e| e == "toml"))
        .collect();
    files.sort();
    let read = |path: std::path::PathBuf| {
        let text = fs::read_to_string(&path).expect("text");
        let folder = path.parent().expect("a folder");
        let mut tables =
            |file: &str| fs::read_to_string(folder.join(file)).map_err(|e| e.to_string());
        let name = path
            .file_stem()
            .expect("a name")
            .to_string_lossy()
            .into_owned();
        let checked = Model::from_toml(&text, &name, &mut tables).expect("a model");
        (name, checked.model)
    };
    files.into_iter().map(read).collect()
}
