//! A solver whose fields live at two places has a file for each.

use crate::folder;
use granular_core::glam::DVec2;
use granular_core::{
    FieldRef, FieldSink, Limits, Location, Memory, Section, Shown, ShownAs, SnapshotError, Solver, StepError,
};
use granular_io::vtk::{read_vti, read_vtp};
use granular_io::{Frame, write_fields};

const PARTICLES: [DVec2; 2] = [DVec2::new(0.25, 0.5), DVec2::new(1.5, 0.75)];

/// Two particles over the six nodes of a grid.
struct Points;

impl Solver for Points {
    fn name(&self) -> &'static str {
        "points"
    }
    fn size(&self) -> (usize, &'static str) {
        (2, "particle")
    }
    fn limits(&self, _: &mut Limits) {}
    fn advance(&mut self, _: f64, _: u64) -> Result<(), StepError> {
        Ok(())
    }
    fn places(&self) -> Vec<(&'static str, Location<'_>)> {
        let nodes = Location::Grid { origin: [0.0; 3], spacing: [1.0; 3], cells: [3, 2, 1] };
        vec![("particles", Location::Points(FieldRef::Vector2(&PARTICLES))), ("nodes", nodes)]
    }
    fn shown(&self) -> Vec<Shown> {
        vec![
            Shown::new("mass", "kg", "mass of a particle", ShownAs::Field),
            Shown::new("momentum", "kg m/s", "momentum of a node", ShownAs::Field).at("nodes"),
            Shown::new("energy", "J", "energy of all", ShownAs::Number),
        ]
    }
    fn show(&self, sink: &mut dyn FieldSink) {
        if sink.wants("mass") {
            sink.field("mass", "kg", FieldRef::Scalar(&[1.0, 2.0]));
        }
        if sink.wants("momentum") {
            sink.field("momentum", "kg m/s", FieldRef::Scalar(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0]));
        }
        if sink.wants("energy") {
            sink.number("energy", "J", 7.0);
        }
    }
    fn save(&self, _: &mut Section) {}
    fn restore(&mut self, _: &Section) -> Result<(), SnapshotError> {
        Ok(())
    }
    fn memory(&self) -> Memory {
        Memory::default()
    }
}

#[test]
fn each_place_has_a_file_with_what_lives_there() {
    let folder = folder("places");
    let write = |place: &str| {
        let mut frame = Frame::of_place(&Points, place);
        Points.show(&mut frame);
        assert_eq!(frame.numbers().len(), 1);
        let location = Points.place(place).unwrap();
        write_fields(&folder, place, &location, &frame, 0.5).unwrap()
    };
    let particles = read_vtp(&write("particles")).unwrap();
    let names: Vec<&str> = particles.fields.iter().map(|(name, ..)| name.as_str()).collect();
    assert_eq!(names, ["mass"]);
    let nodes = read_vti(&write("nodes")).unwrap();
    let names: Vec<&str> = nodes.fields.iter().map(|(name, ..)| name.as_str()).collect();
    assert_eq!(names, ["momentum"]);
    // All that a solver shows does not fit one place, and that is told.
    let mut all = Frame::wanting_all();
    Points.show(&mut all);
    let error = write_fields(&folder, "all", &Points.location(), &all, 0.5).unwrap_err().to_string();
    assert!(error.contains("`momentum` has 6 values for 2 points"), "{error}");
}
