//! Writes one of each kind of file into the folder given as argument, for
//! `crates/io/tests/read_back.py`, which checks names, times and values.

use granular_core::glam::{DVec2, DVec3};
use granular_core::{FieldRef, FieldSink, Location, SymmetricTensor};
use granular_io::{Collection, Frame, IoError, TableWriter};
use std::path::{Path, PathBuf};

/// Times of the three frames \[s\].
const TIMES: [f64; 3] = [0.0, 0.1 + 0.2, 1.5e-7];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).ok_or("usage: write_samples FOLDER")?);
    std::fs::create_dir_all(&folder)?;
    table(&folder)?;
    points(&folder)?;
    nothing(&folder)?;
    grids(&folder)?;
    #[cfg(feature = "hdf5")]
    temporal(&folder)?;
    Ok(())
}

/// A thousand numbers over all exponents, next to their bits as two exact integers.
fn table(folder: &Path) -> Result<(), IoError> {
    let columns = [("value", "J"), ("high_bits", "-"), ("low_bits", "-")];
    let mut table = TableWriter::create(&folder.join("series.csv"), &columns)?.flush_every_row(false);
    let mut bits = 0x3ff0_0000_0000_0000_u64;
    for _ in 0..1000 {
        bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let value = f64::from_bits(bits);
        if value.is_finite() {
            table.row(&[value, (bits >> 32) as f64, (bits & 0xffff_ffff) as f64])?;
        }
    }
    table.flush()
}

/// Fields of `n` points at step `step`; `read_back.py` computes the same values.
fn show(frame: &mut Frame, n: usize, step: usize) {
    let at = |i: usize| (i + 10 * step) as f64;
    let radius: Vec<f64> = (0..n).map(|i| 1e-3 * (1.0 + at(i))).collect();
    let density: Vec<f32> = (0..n).map(|i| 0.5 + at(i) as f32).collect();
    let velocity: Vec<DVec3> = (0..n).map(|i| DVec3::new(at(i), -at(i), 0.25)).collect();
    let flow: Vec<DVec2> = (0..n).map(|i| DVec2::new(at(i), 2.0)).collect();
    let stress: Vec<SymmetricTensor> =
        (0..n).map(|i| SymmetricTensor { xx: at(i), yy: 1.0, zz: 2.0, xy: 3.0, yz: 4.0, xz: 5.0 }).collect();
    let id: Vec<u32> = (0..n as u32).map(|i| u32::MAX - i).collect();
    frame.clear();
    frame.field("radius", "m", FieldRef::Scalar(&radius));
    frame.field("density", "kg/m³", FieldRef::Single(&density));
    frame.field("velocity", "m/s", FieldRef::Vector3(&velocity));
    frame.field("flow", "m/s", FieldRef::Vector2(&flow));
    frame.field("stress", "Pa", FieldRef::Tensor(&stress));
    frame.field("id", "-", FieldRef::Index(&id));
    frame.number("kinetic_energy", "J", 0.5 * at(0));
    let pairs: Vec<[u32; 2]> = (1..n as u32).map(|i| [i - 1, i]).collect();
    frame.links(&pairs);
    frame.link_field("normal_force", "N", FieldRef::Scalar(&radius[..n - 1]));
}

/// Points of the plane; their number grows from step to step.
fn positions(step: usize) -> Vec<DVec2> {
    (0..4 + step).map(|i| DVec2::new(i as f64 + 0.5, 0.1 * step as f64)).collect()
}

/// The plane and space.
fn grid(cells_along_z: usize) -> Location<'static> {
    Location::Grid { origin: [0.5, -1.0, 0.0], spacing: [0.1, 0.2, 0.3], cells: [4, 3, cells_along_z] }
}

fn points(folder: &Path) -> Result<(), IoError> {
    let mut collection = Collection::create(&folder.join("points.pvd"))?;
    let mut frame = Frame::wanting_all();
    for (step, time) in TIMES.into_iter().enumerate() {
        let positions = positions(step);
        let location = Location::Points(FieldRef::Vector2(&positions));
        show(&mut frame, positions.len(), step);
        let file = granular_io::write_fields(folder, &format!("points-{step}"), &location, &frame, time)?;
        granular_io::write_links_vtp(&folder.join(format!("links-{step}.vtp")), &location, &frame, time)?;
        collection.push(time, &file.file_name().unwrap_or_default().to_string_lossy())?;
        // A run that is taken up again goes on with the same list.
        collection = Collection::reopen_at(&folder.join("points.pvd"), step + 1)?;
    }
    Ok(())
}

/// No points and no contacts, as before the first grain is poured.
fn nothing(folder: &Path) -> Result<(), IoError> {
    let mut frame = Frame::wanting_all();
    frame.field("velocity", "m/s", FieldRef::Vector2(&[]));
    frame.link_field("normal_force", "N", FieldRef::Scalar(&[]));
    let location = Location::Points(FieldRef::Vector2(&[]));
    granular_io::write_vtp(&folder.join("empty.vtp"), &location, &frame, 0.0)?;
    granular_io::write_links_vtp(&folder.join("empty-links.vtp"), &location, &frame, 0.0)
}

fn grids(folder: &Path) -> Result<(), IoError> {
    let mut frame = Frame::wanting_all();
    for (name, cells_along_z) in [("plane", 1), ("space", 2)] {
        show(&mut frame, 12 * cells_along_z, 1);
        granular_io::write_fields(folder, name, &grid(cells_along_z), &frame, TIMES[1])?;
    }
    Ok(())
}

/// Four frames each; the writer is closed after the second and taken up again twice.
#[cfg(feature = "hdf5")]
fn temporal(folder: &Path) -> Result<(), IoError> {
    use granular_io::{VtkHdfGrid, VtkHdfPoints};
    let mut frame = Frame::wanting_all();
    let path = folder.join("points.vtkhdf");
    let mut writer = VtkHdfPoints::create(&path)?;
    for step in [0, 1, 2, 1, 2, 3] {
        if step < writer.steps() {
            drop(writer);
            writer = VtkHdfPoints::reopen_at(&path, step)?;
        }
        let positions = positions(step);
        show(&mut frame, positions.len(), step);
        writer.append(&Location::Points(FieldRef::Vector2(&positions)), &frame, 0.5 * step as f64)?;
    }
    for (name, cells_along_z) in [("plane", 1), ("space", 2)] {
        let path = folder.join(format!("{name}.vtkhdf"));
        let grid = grid(cells_along_z);
        let mut writer = VtkHdfGrid::create(&path, &grid)?;
        for step in [0, 1, 2, 1, 2, 3] {
            if step < writer.steps() {
                drop(writer);
                writer = VtkHdfGrid::reopen_at(&path, &grid, step)?;
            }
            show(&mut frame, 12 * cells_along_z, step);
            writer.append(&frame, 0.5 * step as f64)?;
        }
    }
    Ok(())
}
