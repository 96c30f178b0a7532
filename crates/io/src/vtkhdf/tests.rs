use super::*;
use crate::frame::Frame;
use crate::testing::Scratch;
use granular_core::glam::DVec2;
use granular_core::{FieldRef, FieldSink, Location};

fn frame(n: usize, step: usize) -> Frame {
    let mut frame = Frame::wanting_all();
    frame.field("radius", "m", FieldRef::Scalar(&vec![step as f64; n]));
    frame.field("velocity", "m/s", FieldRef::Vector2(&vec![DVec2::new(1.0, step as f64); n]));
    frame.number("energy", "J", step as f64);
    frame
}

fn put(writer: &mut VtkHdfPoints, step: usize) {
    let points = vec![DVec2::splat(step as f64); 3 + step];
    let location = Location::Points(FieldRef::Vector2(&points));
    writer.append(&location, &frame(points.len(), step), step as f64).unwrap();
}

/// All arrays of a file by name, as numbers.
fn contents(path: &std::path::Path) -> Vec<(String, Vec<f64>)> {
    let file = hdf5::File::open(path).unwrap();
    let mut found = Vec::new();
    let mut groups = vec![file.group("VTKHDF").unwrap()];
    while let Some(group) = groups.pop() {
        groups.extend(group.groups().unwrap());
        let read = |d: &hdf5::Dataset| (d.name(), d.read_raw::<f64>().unwrap());
        found.extend(group.datasets().unwrap().iter().map(read));
    }
    let steps: i64 = file.group("VTKHDF/Steps").unwrap().attr("NSteps").unwrap().read_scalar().unwrap();
    found.push(("steps".to_owned(), vec![steps as f64]));
    found.sort_by(|a, b| a.0.cmp(&b.0));
    found
}

#[test]
fn a_resumed_file_of_points_is_the_same_as_one_in_one_go() {
    let folder = Scratch::new("vtkhdf");
    let (straight, resumed) = (folder.path("a.vtkhdf"), folder.path("b.vtkhdf"));
    let mut writer = VtkHdfPoints::create(&straight).unwrap();
    (0..5).for_each(|step| put(&mut writer, step));
    drop(writer);
    for keep in 0..=3 {
        let mut writer = VtkHdfPoints::create(&resumed).unwrap();
        (0..3).for_each(|step| put(&mut writer, step));
        drop(writer);
        let mut writer = VtkHdfPoints::reopen_at(&resumed, keep).unwrap();
        assert_eq!(writer.steps(), keep);
        (keep..5).for_each(|step| put(&mut writer, step));
        drop(writer);
        assert_eq!(contents(&resumed), contents(&straight), "kept {keep}");
    }
    let short = VtkHdfPoints::reopen_at(&resumed, 6).unwrap_err().to_string();
    assert!(short.contains("it has 5 steps where 6 are expected"), "{short}");
}

#[test]
fn a_resumed_file_of_cells_is_the_same_as_one_in_one_go() {
    let folder = Scratch::new("vtkhdf-grid");
    let (straight, resumed) = (folder.path("a.vtkhdf"), folder.path("b.vtkhdf"));
    for cells in [[3, 2, 1], [3, 2, 2]] {
        let grid = Location::Grid { origin: [0.0; 3], spacing: [0.1; 3], cells };
        let count = cells.iter().product();
        let mut writer = VtkHdfGrid::create(&straight, &grid).unwrap();
        (0..4).for_each(|step| writer.append(&frame(count, step), step as f64).unwrap());
        drop(writer);
        for keep in 0..=2 {
            let mut writer = VtkHdfGrid::create(&resumed, &grid).unwrap();
            (0..2).for_each(|step| writer.append(&frame(count, step), step as f64).unwrap());
            drop(writer);
            let mut writer = VtkHdfGrid::reopen_at(&resumed, &grid, keep).unwrap();
            (keep..4).for_each(|step| writer.append(&frame(count, step), step as f64).unwrap());
            drop(writer);
            assert_eq!(contents(&resumed), contents(&straight), "kept {keep} of {cells:?}");
        }
        let other = Location::Grid { origin: [1.0; 3], spacing: [0.1; 3], cells };
        let message = VtkHdfGrid::reopen_at(&resumed, &other, 1).unwrap_err().to_string();
        assert!(message.contains("another grid"), "{message}");
    }
}

#[test]
fn a_frame_with_other_fields_is_refused_and_the_file_goes_on() {
    let folder = Scratch::new("vtkhdf-fields");
    let path = folder.path("a.vtkhdf");
    let mut writer = VtkHdfPoints::create(&path).unwrap();
    put(&mut writer, 0);
    let location = Location::Points(FieldRef::Vector2(&[DVec2::ZERO]));
    let mut other = Frame::wanting(["radius"]);
    other.field("radius", "m", FieldRef::Scalar(&[1.0]));
    let message = writer.append(&location, &other, 1.0).unwrap_err().to_string();
    assert!(message.contains("fields radius, velocity; this frame has radius"), "{message}");
    let mut changed = Frame::wanting_all();
    changed.field("radius", "m", FieldRef::Single(&[1.0]));
    changed.field("velocity", "m/s", FieldRef::Vector2(&[DVec2::ZERO]));
    let message = writer.append(&location, &changed, 1.0).unwrap_err().to_string();
    assert!(message.contains("`radius` has changed its kind"), "{message}");
    put(&mut writer, 1);
    assert_eq!(writer.steps(), 2);
}

#[test]
fn rows_that_a_crash_left_are_cut() {
    let folder = Scratch::new("vtkhdf-crash");
    let (whole, crashed) = (folder.path("a.vtkhdf"), folder.path("b.vtkhdf"));
    for path in [&whole, &crashed] {
        let mut writer = VtkHdfPoints::create(path).unwrap();
        (0..3).for_each(|step| put(&mut writer, step));
    }
    {
        let file = hdf5::File::open_rw(&crashed).unwrap();
        file.dataset("VTKHDF/Points").unwrap().resize((40, 3)).unwrap();
        file.dataset("VTKHDF/Vertices/Offsets").unwrap().resize(33).unwrap();
        file.dataset("VTKHDF/Steps/Values").unwrap().resize(4).unwrap();
    }
    drop(VtkHdfPoints::reopen_at(&crashed, 3).unwrap());
    assert_eq!(contents(&crashed), contents(&whole));
    std::fs::write(&crashed, b"no such format").unwrap();
    assert!(VtkHdfPoints::reopen_at(&crashed, 0).is_err());
    assert!(VtkHdfPoints::reopen_at(&crashed, 1).is_err());
}
