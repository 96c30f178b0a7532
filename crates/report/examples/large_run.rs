//! Makes a folder as a run of many grains leaves it, for measuring pages: `large_run FOLDER [GRAINS] [FRAMES]`.

use granular_core::glam::DVec2;
use granular_core::{FieldRef, FieldSink, Location};
use granular_io::{Collection, Frame, TableWriter, write_fields};
use std::path::{Path, PathBuf};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let folder = PathBuf::from(arguments.next().ok_or("usage: large_run FOLDER [GRAINS] [FRAMES]")?);
    let grains: usize = arguments.next().map_or(Ok(100_000), |text| text.parse())?;
    let frames: usize = arguments.next().map_or(Ok(50), |text| text.parse())?;
    std::fs::create_dir_all(&folder)?;
    let facts = format!(
        "{{\"exit\": \"done\", \"solver\": \"dem\", \"simulated_seconds\": {}, \"steps\": 1000, \"wall_seconds\": 1.0}}",
        frames as f64 * 0.01
    );
    std::fs::write(folder.join("run.json"), facts)?;
    std::fs::write(folder.join("scene.ron"), "Scene(version: 1, title: \"Many grains\", dimension: Plane)")?;
    let mut list = Collection::create(&folder.join("grains.pvd"))?;
    let mut table = TableWriter::create(&folder.join("series.csv"), &[("time", "s"), ("height", "m")])?;
    for step in 0..frames {
        let time = 0.01 * step as f64;
        table.row(&[time, 1.0 / (1.0 + time)])?;
        list.push(time, &frame(&folder, grains, step, time)?)?;
    }
    Ok(())
}

/// A heap that spreads, with a wave of velocity in it; grains in another order in each frame, as a run sorts them in memory.
fn frame(folder: &Path, grains: usize, step: usize, time: f64) -> Result<String, Box<dyn std::error::Error>> {
    let columns = (grains as f64).sqrt().ceil() as usize;
    let spread = 1.0 + time;
    let id = |k: usize| (k + step * 17) % grains;
    let noise = |k: usize| (k as f64 * 12.9898).sin() * 43_758.545_3 % 1.0;
    let place = |k: usize| {
        let (column, row) = ((k % columns) as f64, (k / columns) as f64);
        DVec2::new((column + 0.3 * noise(k)) * 2e-3 * spread, (row + 0.3 * noise(k + 7)) * 2e-3 / spread)
    };
    let velocity = |k: usize| DVec2::new((place(k).x * 9.0 - 8.0 * time).sin(), -0.5 * place(k).y / spread);
    let ids: Vec<u32> = (0..grains).map(|k| id(k) as u32).collect();
    let places: Vec<DVec2> = (0..grains).map(|k| place(id(k))).collect();
    let velocities: Vec<DVec2> = (0..grains).map(|k| velocity(id(k))).collect();
    let radii: Vec<f64> = (0..grains).map(|k| 0.8e-3 + 0.2e-3 * noise(id(k) + 3)).collect();
    let speeds: Vec<f64> = velocities.iter().map(|v| v.length()).collect();
    let mut frame = Frame::wanting_all();
    frame.field("radius", "m", FieldRef::Scalar(&radii));
    frame.field("velocity", "m/s", FieldRef::Vector2(&velocities));
    frame.field("speed", "m/s", FieldRef::Scalar(&speeds));
    frame.field("id", "1", FieldRef::Index(&ids));
    let stem = format!("grains_{step:06}");
    let location = Location::Points(FieldRef::Vector2(&places));
    let path = write_fields(folder, &stem, &location, &frame, time)?;
    Ok(path.file_name().unwrap_or_default().to_string_lossy().into_owned())
}
