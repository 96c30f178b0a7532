//! Friction and solid fraction over the inertial number, as a figure.

use super::{Estimate, MaterialFile, Point};
use crate::failure::Failure;
use crate::scene::Dimension;
use granular_io::figure::{Axis, Chart, Figure, Panels, Series, Style};
use std::path::{Path, PathBuf};

/// Points of a fitted curve.
const CURVE: u32 = 60;
/// Colour of curves from elsewhere: black.
const ELSEWHERE: usize = 7;

/// Draws a material file, as `.svg` and `.png` next to it. Returns the path without ending.
///
/// # Errors
/// When the file cannot be read or is no material file, or the figure cannot be written.
pub fn plot(path: &Path) -> Result<PathBuf, Failure> {
    let text = std::fs::read_to_string(path).map_err(|error| Failure::io(path.display(), error))?;
    let file = MaterialFile::from_ron(&text).map_err(|failure| {
        let no_material = "is a file, but not one that `granular calibrate` wrote";
        failure.with_context(format_args!("{}: {no_material}", path.display()))
    })?;
    let stem = path.with_extension("");
    figure(&file).save(&stem)?;
    Ok(stem)
}

/// Friction and solid fraction over the inertial number: what was measured at each stress with its standard errors, the
/// fits, and what others found for disks \[DaCruz2005\] or glass beads \[Jop2006\].
pub fn figure(file: &MaterialFile) -> Figure {
    let title = if file.title.is_empty() { "Steady shear".to_owned() } else { file.title.clone() };
    let mut panels = Panels::new(title, 2, vec![friction(file), solid_fraction(file)]);
    panels.size = [520.0, 420.0];
    panels.figure()
}

fn friction(file: &MaterialFile) -> Chart {
    let (linear, jop) = (file.linear, file.jop);
    let line = move |number: f64| linear.static_friction.value + linear.slope.value * number;
    let curve = move |number: f64| {
        let rise = jop.dynamic_friction.value - jop.static_friction.value;
        jop.static_friction.value + rise / (1.0 + jop.inertial_number.value / number)
    };
    let chart = chart("shear stress over normal stress [-]", file, |point| point.friction);
    let chart = chart.with(series("line", file, line, Style::Line, 5));
    let chart = chart.with(series("curve that saturates", file, curve, Style::Line, 6));
    match file.dimension {
        Dimension::Plane => {
            let disks = |number: f64| 0.25 + 1.1 * number;
            chart.with(series("da Cruz et al. 2005, disks", file, disks, Style::Dashed, ELSEWHERE))
        }
        Dimension::Space => {
            let [low, high] = [20.9_f64, 32.76].map(|degrees| degrees.to_radians().tan());
            let beads = move |number: f64| low + (high - low) / (1.0 + 0.279 / number);
            chart.with(series("Jop et al. 2006, glass beads", file, beads, Style::Dashed, ELSEWHERE))
        }
    }
}

fn solid_fraction(file: &MaterialFile) -> Chart {
    let fit = file.solid_fraction;
    let line = move |number: f64| fit.static_friction.value + fit.slope.value * number;
    let chart = chart("solid fraction [-]", file, |point| point.solid_fraction);
    let chart = chart.with(series("line", file, line, Style::Line, 5));
    if file.dimension == Dimension::Space {
        return chart;
    }
    let disks = |number: f64| 0.81 - 0.3 * number;
    chart.with(series("da Cruz et al. 2005, disks", file, disks, Style::Dashed, ELSEWHERE))
}

/// What was measured, a series per stress.
fn chart(label: &str, file: &MaterialFile, of: fn(&Point) -> Estimate) -> Chart {
    let mut chart = Chart::new("", Axis::log("inertial number [-]"), Axis::linear(label));
    let mut levels: Vec<f64> = file.points.iter().map(|point| point.stress_over_modulus).collect();
    levels.dedup();
    for (colour, level) in levels.into_iter().enumerate() {
        let mine = file.points.iter().filter(|point| point.stress_over_modulus == level);
        let (points, errors) = mine
            .map(|point| ([point.inertial_number.value, of(point).value], of(point).error))
            .unzip::<_, _, Vec<_>, Vec<_>>();
        let label = format!("stress {level:.0e} of the stiffness");
        chart = chart.with(Series::new(label, points, Style::ErrorBars(errors)).colour(colour));
    }
    chart
}

/// A curve over the inertial numbers that were measured.
fn series(
    label: &str,
    file: &MaterialFile,
    curve: impl Fn(f64) -> f64,
    style: Style,
    colour: usize,
) -> Series {
    let numbers = file.points.iter().map(|point| point.inertial_number.value);
    let (low, high) = numbers.fold((f64::INFINITY, 0.0_f64), |(low, high), x| (low.min(x), high.max(x)));
    let place = |k: u32| low * (high / low).powf(f64::from(k) / f64::from(CURVE));
    let points = (0..=CURVE).map(|k| [place(k), curve(place(k))]).collect();
    Series::new(label, points, style).colour(colour)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material_file::example as material;

    #[test]
    fn a_figure_has_a_series_per_stress_and_what_others_found() {
        for (dimension, others) in [(Dimension::Plane, "da Cruz"), (Dimension::Space, "Jop")] {
            let file = material(dimension);
            let labels: Vec<String> =
                friction(&file).series.iter().map(|series| series.label.clone()).collect();
            assert_eq!(labels[..2], ["stress 1e-3 of the stiffness", "stress 3e-4 of the stiffness"]);
            assert!(labels.last().is_some_and(|label| label.contains(others)), "{labels:?}");
            assert!(figure(&file).svg().contains("solid fraction"));
        }
    }

    #[test]
    fn curves_are_those_of_the_fits() {
        let file = material(Dimension::Plane);
        let line = &friction(&file).series[2];
        assert_eq!((line.points[0][0], line.points[CURVE as usize][0]), (0.01, 0.1));
        assert!(line.points.iter().all(|[x, y]| (y - 0.25 - x).abs() < 1e-12));
        let last = friction(&file).series[3].points[CURVE as usize];
        assert!((last[1] - (0.25 + 0.35 / (1.0 + 0.3 / last[0]))).abs() < 1e-12);
    }

    #[test]
    fn a_file_comes_back_as_it_was() {
        let file = material(Dimension::Space);
        assert_eq!(MaterialFile::from_ron(&file.to_ron().unwrap()).unwrap(), file);
        let other = file.to_ron().unwrap().replace("version: 1", "version: 2");
        assert!(MaterialFile::from_ron(&other).unwrap_err().to_string().contains("reads version 1"));
    }
}
