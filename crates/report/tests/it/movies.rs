//! Frames over time.

use crate::support::{Page, Scratch, grains, speeds};
use granular_core::glam::{DVec2, DVec3};
use granular_core::{FieldRef, FieldSink, Location};
use granular_io::{Collection, Frame, write_fields};
use serde_json::{Value, json};
use std::fs;

fn channel<'a>(movie: &'a Value, field: &str, component: &str) -> &'a Value {
    let channels = movie["channels"].as_array().unwrap();
    let is_it = |channel: &&Value| channel["field"] == field && channel["component"] == component;
    channels.iter().find(is_it).unwrap_or_else(|| panic!("no {field} {component}"))
}

#[test]
fn grains_come_back_in_the_order_of_their_identifiers_to_the_stated_precision() {
    let scratch = Scratch::new("order");
    let page = Page::of(&scratch, &[scratch.run("a")]);
    let data = page.data();
    let movie = &data["runs"][0]["movies"][0];
    assert_eq!(movie["times"], json!([0.0, 0.25, 0.5]));
    assert_eq!(movie["counts"], json!([2, 2, 2]));
    let speed = channel(movie, "speed", "");
    assert_eq!((&speed["unit"], &speed["bytes"]), (&json!("m/s"), &json!(2)));
    for frame in 0..3 {
        let (values, error) = page.values(speed, frame);
        assert!(error < 7.0 / 65534.0, "{error}");
        for (found, wanted) in values.iter().zip(speeds(frame)) {
            assert!((found - wanted).abs() <= 1.0001 * error, "{found} for {wanted}");
        }
        let (x, error) = page.values(channel(movie, "", "x"), frame);
        assert!(x[0].abs() <= error && (x[1] - 0.1 * frame as f64).abs() <= 1.0001 * error, "{x:?}");
    }
    let places = movie["channels"].as_array().unwrap().iter().filter(|channel| channel["place"] == true);
    assert_eq!(places.count(), 2, "grains of the plane have no z");
    // What never changes is there once.
    let radius = &channel(movie, "radius", "")["arrays"];
    assert!(radius[0] == radius[1] && radius[0] == radius[2]);
}

#[test]
fn what_is_too_large_loses_digits_first_and_frames_then() {
    let scratch = Scratch::new("budget");
    let folder = scratch.bare("a");
    grains(&folder, 40, |k| DVec2::new(k as f64, 1.0));
    let frames = |page: &Page| page.data()["runs"][0]["movies"][0]["times"].as_array().unwrap().len();
    let bits = |page: &Page| page.data()["plan"]["bits"].clone();
    let exact = Page::of(&scratch, std::slice::from_ref(&folder));
    assert_eq!((frames(&exact), bits(&exact)), (40, json!(16)));
    let coarse = Page::within(&scratch, std::slice::from_ref(&folder), 600);
    assert_eq!((frames(&coarse), bits(&coarse)), (40, json!(8)));
    let speed = channel(&coarse.data()["runs"][0]["movies"][0], "speed", "").clone();
    let (values, error) = coarse.values(&speed, 39);
    assert!((values[1] - speeds(39)[1]).abs() <= 1.0001 * error && error < 0.1, "{values:?} to {error}");
    let few = Page::within(&scratch, std::slice::from_ref(&folder), 200);
    let movie = &few.data()["runs"][0]["movies"][0];
    let times = movie["times"].as_array().unwrap();
    assert!(times.len() <= 14 && times.len() > 8, "{times:?}");
    assert_eq!((&times[0], times.last().unwrap(), &movie["frames"]), (&json!(0.0), &json!(9.75), &json!(40)));
    // Nothing fits, but the ends are there.
    let none = Page::within(&scratch, &[folder], 0);
    assert!(frames(&none) <= 2);
}

#[test]
fn of_a_grid_in_space_the_middle_planes_are_there() {
    let scratch = Scratch::new("grid");
    let folder = scratch.bare("a");
    let cells = [3, 4, 5];
    let values: Vec<f64> = (0..60).map(f64::from).collect();
    let vectors: Vec<DVec3> = values.iter().map(|value| DVec3::new(*value, 0.0, -value)).collect();
    let mut frame = Frame::wanting_all();
    frame.field("pressure", "Pa", FieldRef::Scalar(&values));
    frame.field("velocity", "m/s", FieldRef::Vector3(&vectors));
    let location = Location::Grid { origin: [0.0; 3], spacing: [0.1; 3], cells };
    write_fields(&folder, "water_0", &location, &frame, 0.0).unwrap();
    Collection::create(&folder.join("water.pvd")).unwrap().push(0.0, "water_0.vti").unwrap();
    let page = Page::of(&scratch, &[folder]);
    let data = page.data();
    let movies = data["runs"][0]["movies"].as_array().unwrap();
    let of = |k: usize| (&movies[k]["plane"]["normal"], &movies[k]["plane"]["cells"]);
    assert_eq!(
        [of(0), of(1), of(2)],
        [(&json!(2), &json!([3, 4])), (&json!(1), &json!([3, 5])), (&json!(0), &json!([4, 5]))]
    );
    // The middle layer of five begins with cell 2 * 12.
    let (found, error) = page.values(channel(&movies[0], "pressure", ""), 0);
    assert!(
        (found[0] - 24.0).abs() <= error + 1e-12 && (found[11] - 35.0).abs() <= error + 1e-12,
        "{found:?}"
    );
    assert!(movies[0]["channels"].as_array().unwrap().iter().all(|channel| channel["component"] != "y"));
}

#[test]
fn contacts_and_damaged_frames_are_told_of() {
    let scratch = Scratch::new("damaged");
    let folder = scratch.run("a");
    fs::write(folder.join("grains_1.vtp"), "noise").unwrap();
    let points = [DVec2::ZERO, DVec2::X];
    let mut frame = Frame::wanting_all();
    frame.links(&[[0, 1]]);
    frame.link_field("normal_force", "N", FieldRef::Scalar(&[7.0]));
    let location = Location::Points(FieldRef::Vector2(&points));
    granular_io::write_links_vtp(&folder.join("contacts_0.vtp"), &location, &frame, 0.0).unwrap();
    Collection::create(&folder.join("contacts.pvd")).unwrap().push(0.0, "contacts_0.vtp").unwrap();
    Collection::create(&folder.join("outside.pvd")).unwrap().push(0.0, "../b/grains_0.vtp").unwrap();
    let page = Page::of(&scratch, &[folder]);
    assert_eq!(page.data()["runs"][0]["movies"], json!([]));
    let said = page.written.left_out.join("\n");
    for part in [
        "grains.pvd are left out: grains_1.vtp: it is not",
        "Contacts (contacts.pvd)",
        "lists `../b/grains_0.vtp`",
    ] {
        assert!(said.contains(part), "{part}: {said}");
    }
}

#[test]
fn values_that_are_no_numbers_are_missing() {
    let scratch = Scratch::new("missing");
    let folder = scratch.bare("a");
    let mut frame = Frame::wanting_all();
    frame.field("stress", "Pa", FieldRef::Scalar(&[f64::NAN, f64::INFINITY, -2.0, 3.0]));
    let points = [DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::ONE];
    write_fields(&folder, "p_0", &Location::Points(FieldRef::Vector2(&points)), &frame, 0.0).unwrap();
    Collection::create(&folder.join("p.pvd")).unwrap().push(0.0, "p_0.vtp").unwrap();
    let page = Page::of(&scratch, &[folder]);
    let data = page.data();
    let stress = channel(&data["runs"][0]["movies"][0], "stress", "");
    assert_eq!(page.bytes(&stress["arrays"][0]), [255, 255, 255, 255, 0, 0, 254, 255]);
    assert_eq!(stress["low"], json!(-2.0));
}
