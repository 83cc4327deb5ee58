//! Finds all solutions of generic data of nine points and its kin, which those of given data are led from: some seconds, once.

use std::path::Path;

use kempe_alt_burmester::{Kind, StartSet};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("cargo::rerun-if-changed=build.rs");
    let folder = std::env::var_os("OUT_DIR").ok_or("cargo gives build scripts a folder")?;
    for kind in Kind::ALL {
        let found = StartSet::found(kind).ok_or("solutions of generic data are missing")?;
        let name = format!("starts_{}.bin", kind.turns());
        std::fs::write(Path::new(&folder).join(name), found.to_bytes())?;
    }
    Ok(())
}
