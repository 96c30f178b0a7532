//! Continua with known answers: error against cells, particles in a cell, shape functions and scheme.
//!
//! A study is a list of [`Run`]s and a function that measures one; a manufactured solution is one more of each.

mod bar;
mod column;

use crate::bench::Precision;
use crate::bench::study::{Point, Study};
use granular_driver::failure::Failure;
use granular_driver::parallel;
use granular_driver::statistics::order;
use granular_mpm::{Scheme, ShapeFunctions};
use std::collections::BTreeMap;
use std::time::Instant;

pub(super) const STUDIES: &[Precision] = &[
    Precision {
        name: "vibrating-bar",
        about: "First mode of an elastic bar over cells, particles, shape functions and scheme; takes half a minute",
        run: bar::study,
    },
    Precision {
        name: "self-weight",
        about: "Elastic column under its own weight over the same; takes a minute",
        run: column::study,
    },
];

/// One run.
#[derive(Clone, Debug)]
struct Run {
    /// What stays the same along a curve.
    scheme: String,
    shape: ShapeFunctions,
    when: Scheme,
    /// Cells along the body.
    cells: usize,
    /// Particles along an edge of a cell.
    along: usize,
}

/// What a run comes to.
struct Measured {
    dt: f64,
    error: f64,
    /// What else there is to say of it.
    said: String,
}

/// What a study is of.
struct About {
    case: &'static str,
    error: &'static str,
    notes: Vec<String>,
}

/// Shape functions by the names in a figure.
const SHAPES: [(&str, ShapeFunctions); 3] = [
    ("linear", ShapeFunctions::Linear),
    ("GIMP", ShapeFunctions::UniformGimp),
    ("B-spline", ShapeFunctions::QuadraticBspline),
];

/// All shape functions with modified stress last and 4 particles in a cell; then one shape function with the other schemes, and with
/// other numbers of particles.
fn runs(cells: &[usize]) -> Vec<Run> {
    let modified = Scheme::ModifiedStressLast;
    let mut list = Vec::new();
    let mut add = |scheme: String, shape, when, along| {
        list.extend(cells.iter().map(|&cells| Run { scheme: scheme.clone(), shape, when, cells, along }));
    };
    for (name, shape) in SHAPES {
        add(name.to_owned(), shape, modified, 2);
    }
    let (gimp, shape) = SHAPES[1];
    add(format!("{gimp}, stress last"), shape, Scheme::StressLast, 2);
    add(format!("{gimp}, stress first"), shape, Scheme::StressFirst, 2);
    for along in [1, 4] {
        add(format!("{gimp}, {} particles a cell", along * along), shape, modified, along);
    }
    list
}

/// Runs everything, each run on one thread, and fits orders.
fn study(
    about: About,
    runs: &[Run],
    measure: fn(&Run) -> Result<Measured, Failure>,
) -> Result<Study, Failure> {
    let About { case, error, mut notes } = about;
    // The longest runs first, so that no thread is left waiting at the end.
    let mut queue: Vec<usize> = (0..runs.len()).collect();
    queue.sort_by_key(|&index| std::cmp::Reverse(runs[index].cells.pow(2) * runs[index].along.pow(2)));
    let mut done = parallel::each(&queue, |&index| {
        let begun = Instant::now();
        let measured = measure(&runs[index])?;
        Ok((index, measured, begun.elapsed().as_secs_f64()))
    })?;
    done.sort_by_key(|(index, ..)| *index);
    notes.push("modified stress last and 4 particles in a cell where nothing else is said".to_owned());
    notes.push(
        "wall time of a run on one thread, set-up included; runs go side by side on all threads".to_owned(),
    );
    notes.push("orders are least squares in the logarithms of cell and error".to_owned());
    let mut points = Vec::new();
    for (index, measured, seconds) in done {
        let run = &runs[index];
        if !measured.said.is_empty() {
            notes.push(format!("{}, {} cells: {}", run.scheme, run.cells, measured.said));
        }
        let Measured { dt, error, .. } = measured;
        points.push(Point::of_one_run(&run.scheme, run.cells as f64, dt, error, seconds));
    }
    let orders = orders(&points);
    Ok(Study { case, error, resolution: "cells", points, orders, notes }.mark_front())
}

/// Orders of the schemes, from three points or more.
fn orders(points: &[Point]) -> BTreeMap<String, f64> {
    let mut lines: BTreeMap<String, Vec<(f64, f64)>> = BTreeMap::new();
    for point in points {
        lines.entry(point.scheme.clone()).or_default().push((1.0 / point.resolution, point.error));
    }
    lines.retain(|_, line| line.len() > 2);
    lines.into_iter().map(|(scheme, line)| (scheme, order(&line))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bar_of_few_cells_is_of_second_order_and_a_column_of_first_at_least() {
        for (measure, least) in
            [(bar::measure as fn(&Run) -> Result<Measured, Failure>, 1.5), (column::measure, 0.8)]
        {
            let list: Vec<Run> = runs(&[6, 12, 24]).into_iter().filter(|run| run.scheme == "GIMP").collect();
            let about = About { case: "case", error: "error", notes: Vec::new() };
            let study = study(about, &list, measure).unwrap();
            assert!(study.points.len() == 3 && study.orders["GIMP"] > least, "{study}");
        }
    }

    #[test]
    fn every_choice_is_varied_on_its_own() {
        let list = runs(&[10, 20]);
        let schemes: std::collections::BTreeSet<&str> = list.iter().map(|run| run.scheme.as_str()).collect();
        assert_eq!((list.len(), schemes.len()), (14, 7));
    }
}
