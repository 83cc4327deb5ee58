//! Draws a set of hand-made mechanisms in every format: `cargo run -p kempe-draw --example showcase -- OUT_DIR`.

mod forces;
mod mechanisms;
mod reports;

use std::path::Path;

use kempe_draw::raster::animation::{self, AnimationOptions};
use kempe_draw::{DrawOptions, Stage, Theme, dxf, raster, svg};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let out = std::env::args()
        .nth(1)
        .unwrap_or_else(|| "out/showcase".into());
    let out = Path::new(&out);
    std::fs::create_dir_all(out)?;
    for case in mechanisms::all().into_iter().chain(forces::all()) {
        let pose = case.frames.len() / 8;
        let stage = Stage::new(&case.view, &case.frames, DrawOptions::default());
        let scene = stage.scene(pose);
        let write = |extension: &str, bytes: &[u8]| {
            std::fs::write(out.join(format!("{}.{extension}", case.file)), bytes)
        };
        write("svg", svg::document(&scene, Theme::Light).as_bytes())?;
        write("png", &raster::png(&scene, Theme::Light, 150.0)?)?;
        write("dark.png", &raster::png(&scene, Theme::Dark, 150.0)?)?;
        write("dxf", dxf::document(&stage, pose).as_bytes())?;
        let ghosts = DrawOptions {
            ghosts: vec![0, case.frames.len() / 3],
            ..DrawOptions::default()
        };
        let ghosts = Stage::new(&case.view, &case.frames, ghosts);
        write(
            "ghosts.svg",
            svg::document(&ghosts.scene(pose), Theme::Light).as_bytes(),
        )?;
        write(
            "gif",
            &animation::gif(&stage, &AnimationOptions::default())?,
        )?;
        write(
            "apng",
            &animation::apng(&stage, &AnimationOptions::default())?,
        )?;
    }
    let report = reports::report(&[forces::all(), mechanisms::all()].concat());
    std::fs::write(out.join("report.html"), report.to_html())?;
    for (number, plot) in report.motions[0].plots.iter().enumerate() {
        let scene = plot.draw(150.0, 90.0).scene;
        std::fs::write(
            out.join(format!("plot-{number}.svg")),
            svg::document(&scene, Theme::Light),
        )?;
        std::fs::write(
            out.join(format!("plot-{number}.png")),
            raster::png(&scene, Theme::Light, 110.0)?,
        )?;
    }
    Ok(())
}
