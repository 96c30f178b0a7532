//! What the writers refuse, and what is in the text of the files. `tests/read_back.py` checks the
//! values with the readers of VTK and pandas.

use crate::{folder, names};
use granular_core::glam::DVec2;
use granular_core::{FieldRef, FieldSink, Location};
use granular_io::{Frame, write_fields, write_links_vtp, write_vti, write_vtp};

const GRID: Location<'static> = Location::Grid { origin: [0.0; 3], spacing: [0.1; 3], cells: [2, 3, 1] };

#[test]
fn fields_that_do_not_fit_are_refused_by_name() {
    let folder = folder("misfits");
    let points = [DVec2::ZERO; 3];
    let location = Location::Points(FieldRef::Vector2(&points));
    let mut frame = Frame::wanting_all();
    frame.field("radius", "m", FieldRef::Scalar(&[1.0; 2]));
    let path = folder.join("a.vtp");
    let message = write_vtp(&path, &location, &frame, 0.0).unwrap_err().to_string();
    assert!(message.contains("field `radius` has 2 values for 3 points"), "{message}");
    let message = write_vti(&path, &GRID, &frame, 0.0).unwrap_err().to_string();
    assert!(message.contains("field `radius` has 2 values for 6 cells"), "{message}");
    frame.clear();
    frame.field("id", "-", FieldRef::Index(&[1, 2, 3]));
    frame.field("id", "-", FieldRef::Index(&[1, 2, 3]));
    assert!(write_vtp(&path, &location, &frame, 0.0).unwrap_err().reason.contains("shown twice"));
    frame.clear();
    frame.links(&[[0, 3]]);
    let message = write_links_vtp(&path, &location, &frame, 0.0).unwrap_err().to_string();
    assert!(message.contains("a link names point 3 of 3"), "{message}");
    assert!(write_vti(&path, &location, &frame, 0.0).unwrap_err().reason.contains("no grid"));
    assert!(write_vtp(&path, &GRID, &frame, 0.0).unwrap_err().reason.contains("no points"));
    assert!(names(&folder).is_empty());
}

#[test]
fn the_ending_follows_the_location() {
    let folder = folder("endings");
    let frame = Frame::wanting_all();
    let none: [DVec2; 0] = [];
    let points = Location::Points(FieldRef::Vector2(&none));
    write_fields(&folder, "points", &points, &frame, 0.0).unwrap();
    write_fields(&folder, "cells", &GRID, &frame, 1.5e-7).unwrap();
    assert_eq!(names(&folder), ["cells.vti", "points.vtp"]);
    let bytes = std::fs::read(folder.join("cells.vti")).unwrap();
    let text = String::from_utf8_lossy(&bytes);
    assert!(text.contains("WholeExtent=\"0 2 0 3 0 0\"") && text.contains(">1.5e-7<"), "{text}");
}

#[test]
fn a_frame_says_what_it_missed() {
    let mut frame = Frame::wanting(["radius", "energy", "spin"]);
    assert!(frame.wants("spin") && !frame.wants("mass"));
    frame.field("radius", "m", FieldRef::Scalar(&[1.0]));
    frame.field("mass", "kg", FieldRef::Scalar(&[1.0]));
    frame.number("energy", "J", 2.0);
    assert_eq!(frame.missing(), ["spin"]);
    assert_eq!(frame.fields().len(), 1);
    assert_eq!(frame.get("radius").unwrap().unit, "m");
    frame.clear();
    assert_eq!(frame.missing().len(), 3);
}
