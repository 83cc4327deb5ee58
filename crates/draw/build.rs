//! Stores the font of the raster pictures compressed: it is half of what they add to a program.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    #[cfg(feature = "raster")]
    store_font();
}

#[cfg(feature = "raster")]
fn store_font() {
    /// miniz's best but one: the last one takes far longer for next to nothing.
    const LEVEL: u8 = 9;
    let Ok(folder) = std::env::var("OUT_DIR") else {
        return;
    };
    let font = dejavu::sans_condensed::regular();
    let stored = miniz_oxide::deflate::compress_to_vec(font, LEVEL);
    let path = std::path::Path::new(&folder).join("font.deflate");
    if let Err(why) = std::fs::write(&path, stored) {
        println!("cargo::error=cannot write {}: {why}", path.display());
    }
}
