//! The scene before its first step: grains, walls, places where grains come and go, and obstacles of a fluid.

use super::flow::{axes, in_plane};
use super::map::{outline, upward};
use super::title;
use super::walls::{Line, Reach, Walls};
use crate::column::ColumnSize;
use crate::failure::Failure;
use crate::model::Model;
use crate::scene::boundaries::OutletSpec;
use crate::scene::fluid::FaceSpec;
use crate::scene::{Scene, WallSpec};
use granular_core::units::Length;
use granular_core::{Location, Solver};
use granular_io::figure::{Grain, GrainFigure, GrainPanel, Mark};
use granular_io::{Frame, Values};
use std::path::{Path, PathBuf};

/// What a sample takes up \[m\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Extents {
    /// Lowest coordinate of any point of a grain along each axis.
    pub(crate) low: [f64; 3],
    /// Highest one.
    pub(crate) high: [f64; 3],
}

impl Extents {
    /// Of the grains of a solver; none where there are none.
    pub(crate) fn of(solver: &dyn Solver) -> Option<Self> {
        let mut found: Option<Self> = None;
        for (place, radius) in grains(solver) {
            let [low, high] = [-radius, radius].map(|by| place.map(|x| x + by));
            let all = found.get_or_insert(Self { low, high });
            all.low = std::array::from_fn(|k| all.low[k].min(low[k]));
            all.high = std::array::from_fn(|k| all.high[k].max(high[k]));
        }
        found
    }

    /// Size along an axis \[m\].
    pub(crate) fn size(&self, axis: usize) -> f64 {
        self.high[axis] - self.low[axis]
    }
}

/// Between which x the walls of a scene that have ends lie \[m\]; none without any.
pub(crate) fn ends_of_walls(scene: &Scene, column: Option<ColumnSize>) -> Option<[f64; 2]> {
    Walls { scene, column, records: &[] }.ends()
}

/// Places and radii of the grains of a solver \[m\].
fn grains(solver: &dyn Solver) -> Vec<([f64; 3], f64)> {
    let Location::Points(points) = solver.location() else { return Vec::new() };
    let mut frame = Frame::wanting(["radius"]);
    solver.show(&mut frame);
    match (Values::from(points), frame.get("radius").map(|field| &field.values)) {
        (Values::Vector(places), Some(Values::Scalar(radii))) => {
            places.into_iter().zip(radii.iter().copied()).collect()
        }
        _ => Vec::new(),
    }
}

/// Draws a scene before its first step as `.svg` and `.png`; an ending of the path is left out. Returns both paths.
pub(crate) fn draw(scene: &Scene, model: &Model, path: &Path) -> Result<[PathBuf; 2], Failure> {
    let known = path.extension().is_some_and(|ending| ending == "svg" || ending == "png");
    let stem = if known { path.with_extension("") } else { path.to_path_buf() };
    Ok(figure(scene, model).figure().save(&stem)?)
}

fn figure(scene: &Scene, model: &Model) -> GrainFigure {
    let solvers: Vec<&dyn Solver> =
        model.members.iter().map(|member| member.solver(&model.simulation)).collect();
    let all: Vec<_> = solvers.iter().flat_map(|solver| grains(*solver)).collect();
    let sizes = all.iter().fold([f64::INFINITY, 0.0], |[low, high], (_, r)| [r.min(low), r.max(high)]);
    let of_one_size = sizes[1] - sizes[0] <= 1e-9 * sizes[1];
    let grain = |(place, radius): &([f64; 3], f64)| Grain {
        center: in_plane(scene, *place),
        radius: 1e3 * radius,
        value: if of_one_size { f64::NAN } else { 1e3 * radius },
    };
    let mut panel = GrainPanel { grains: all.iter().map(grain).collect(), ..GrainPanel::default() };
    let walls = Walls { scene, column: model.column(), records: &[] };
    panel.marks = marks(scene, &solvers);
    // Before the first stage all walls stand, also those that will move.
    let before = -1.0;
    let reach = reach(&panel);
    panel.walls = walls.lines(before, reach);
    panel.marks.extend(named(&walls, reach));
    let sizes = solvers.iter().map(|solver| solver.size()).map(|(count, item)| format!("{count} {item}s"));
    let sizes = sizes.collect::<Vec<_>>().join(", ");
    let quantity = if of_one_size { "" } else { "radius [mm]" };
    let mut figure = GrainFigure::new(title(scene, "before the first step"), quantity, vec![panel]);
    figure.axes = axes(scene);
    figure.note = format!("{sizes}; black: walls, orange: what comes, goes, opens, or is of a fluid");
    figure
}

/// What has a name or an end, besides walls.
fn marks(scene: &Scene, solvers: &[&dyn Solver]) -> Vec<Mark> {
    let place =
        |at: &[Length]| in_plane(scene, std::array::from_fn(|axis| at.get(axis).map_or(0.0, |x| x.value())));
    let area = |low: &[Length], high: &[Length], label: &str| {
        let ([a, b], [c, d]) = (place(low), place(high));
        let points = vec![[a, b], [c, b], [c, d], [a, d]];
        Mark { points, closed: true, dashed: true, label: label.to_owned() }
    };
    let mut marks = Vec::new();
    for inlet in &scene.inlets {
        marks.push(area(&inlet.low, &inlet.high, &format!("inlet {}", inlet.name)));
    }
    for outlet in &scene.outlets {
        if let OutletSpec::Outside { low, high } = outlet {
            marks.push(area(low, high, "outlet beyond"));
        }
    }
    if let Some(cell) = scene.cell.as_ref().filter(|cell| !cell.size.is_empty()) {
        let high: Vec<Length> = (0..cell.size.len())
            .map(|axis| (cell.low.get(axis).map_or(0.0, |x| x.value()) + cell.size[axis].value()).into())
            .collect();
        marks.push(area(&cell.low, &high, "periodic cell"));
    }
    marks.extend(solvers.iter().flat_map(|solver| of_fluid(scene, *solver)));
    marks
}

/// Faces, obstacles and gauges of a fluid.
fn of_fluid(scene: &Scene, solver: &dyn Solver) -> Vec<Mark> {
    let (Some(fluid), Location::Grid { origin, spacing, cells }) = (&scene.fluid, solver.location()) else {
        return Vec::new();
    };
    let up = upward(scene);
    let end = |axis: usize| 1e3 * (origin[axis] + spacing[axis] * cells[axis] as f64);
    let ([a, b], [c, d]) = ([0, up].map(|axis| 1e3 * origin[axis]), [0, up].map(end));
    let faces = &fluid.faces;
    let sides = [
        ("left", [[a, b], [a, d]], &faces.left),
        ("right", [[c, b], [c, d]], &faces.right),
        ("bottom", [[a, b], [c, b]], &faces.bottom),
        ("top", [[a, d], [c, d]], &faces.top),
    ];
    let side = |(name, ends, face): (&str, Line, &Option<FaceSpec>)| {
        let (kind, dashed) = match face {
            None | Some(FaceSpec::Periodic) => ("periodic", true),
            Some(FaceSpec::Wall) => ("wall", false),
            Some(FaceSpec::MovingWall(_) | FaceSpec::RegularisedLid(_)) => ("moving wall", false),
            Some(FaceSpec::NavierSlip { .. }) => ("wall with slip", false),
            Some(FaceSpec::FreeSlip) => ("free slip", false),
            Some(FaceSpec::Inflow(_)) => ("inflow", true),
            Some(FaceSpec::Outflow(_)) => ("outflow", true),
            Some(FaceSpec::Absorbing(_)) => ("absorbing", true),
        };
        Mark { points: ends.to_vec(), closed: false, dashed, label: format!("{name}: {kind}") }
    };
    let obstacles = fluid.obstacles.iter().map(|body| {
        let points = outline(scene, body).into_iter().map(|point| point.map(|x| 1e3 * x)).collect();
        Mark { points, closed: true, dashed: false, label: body.name.clone() }
    });
    let gauges = fluid.gauges.iter().map(|(name, at)| {
        let at = std::array::from_fn(|axis| at.get(axis).map_or(0.0, |x| x.value()));
        Mark { points: vec![in_plane(scene, at)], label: name.clone(), ..Mark::default() }
    });
    sides.into_iter().map(side).chain(obstacles).chain(gauges).collect()
}

/// What grains and marks take up, with some room.
fn reach(panel: &GrainPanel) -> Reach {
    let grains = panel.grains.iter().flat_map(|grain| {
        let ([x, y], r) = (grain.center, grain.radius);
        [[x - r, y - r], [x + r, y + r]]
    });
    let marks = panel.marks.iter().flat_map(|mark| mark.points.iter().copied());
    let (mut low, mut high) = ([0.0_f64; 2], [0.0_f64; 2]);
    for [x, y] in grains.chain(marks) {
        (low, high) = ([low[0].min(x), low[1].min(y)], [high[0].max(x), high[1].max(y)]);
    }
    let room = [0, 1].map(|k| 0.03 * (high[k] - low[k]));
    [[low[0] - room[0], low[1] - room[1]], [high[0] + room[0], high[1] + room[1]]]
}

/// Walls that open and planes beyond which grains are taken out, with their names.
fn named(walls: &Walls<'_>, reach: Reach) -> Vec<Mark> {
    let mut marks = Vec::new();
    for wall in &walls.scene.walls {
        let label = match (wall.opens(), wall) {
            (Some(stage), WallSpec::Gate { .. }) => format!("opens at {stage}"),
            (Some(stage), _) => format!("{} opens at {stage}", wall.name()),
            _ => continue,
        };
        let lines = walls.lines_of(&[wall], reach);
        let label = |k: usize| if k == 0 { label.clone() } else { String::new() };
        let lines = lines.into_iter().enumerate();
        marks.extend(lines.map(|(k, line)| Mark {
            points: line.to_vec(),
            dashed: true,
            label: label(k),
            ..Mark::default()
        }));
    }
    for outlet in &walls.scene.outlets {
        if let OutletSpec::Beyond { point, normal } = outlet
            && let Some(line) = walls.plane(point, normal, grown(reach, walls, point))
        {
            let label = "outlet beyond".to_owned();
            marks.push(Mark { points: line.to_vec(), dashed: true, label, ..Mark::default() });
        }
    }
    marks
}

/// Corners that hold a point too.
fn grown([low, high]: Reach, walls: &Walls<'_>, point: &[Length]) -> Reach {
    let at = in_plane(walls.scene, std::array::from_fn(|k| point.get(k).map_or(0.0, |x| x.value())));
    [std::array::from_fn(|k: usize| low[k].min(at[k])), std::array::from_fn(|k: usize| high[k].max(at[k]))]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check;
    use crate::scene_file::SceneText;

    fn drawn(name: &str, text: &str) -> (GrainFigure, String) {
        let (scene, model) = check::read(&SceneText::new(name, text)).unwrap();
        let figure = figure(&scene, &model);
        let svg = figure.figure().svg();
        (figure, svg)
    }

    #[test]
    fn a_hopper_is_drawn_with_its_walls_inlet_and_outlet_before_any_grain() {
        let text = include_str!("../../../../examples/ch3_hopper/scene.ron");
        let (figure, svg) = drawn("hopper", text);
        // Two chains of three segments, and the slide.
        assert_eq!((figure.panels[0].walls.len(), figure.panels[0].grains.len()), (7, 0));
        for label in ["inlet rain", "slide opens at flow", "outlet beyond"] {
            assert!(svg.contains(&format!(">{label}</text>")), "{label}");
        }
    }

    #[test]
    fn a_column_has_its_extents_and_a_fluid_its_faces_and_obstacles() {
        let of = |wanted: &str| crate::TEMPLATES.iter().find(|(name, _)| *name == wanted).unwrap().1;
        let (figure, svg) = drawn("column", of("column-collapse"));
        let (scene, model) = check::read(&SceneText::new("column", of("column-collapse"))).unwrap();
        let found = Extents::of(model.simulation.solver()).unwrap();
        let width = model.column().unwrap().width;
        assert!((found.size(0) / width - 1.0).abs() < 0.05 && found.low[1] > -1e-4, "{found:?} {width}");
        assert_eq!(figure.panels[0].grains.len(), model.simulation.solver().size().0);
        // Floor, left wall and gate, whose name is told.
        assert_eq!((figure.panels[0].walls.len(), scene.walls.len()), (3, 3));
        assert!(svg.contains(">opens at "), "{svg}");
        let (figure, svg) = drawn("cylinder", of("cylinder"));
        assert!(svg.contains(">left: inflow</text>") && svg.contains(">cylinder</text>"), "{svg}");
        assert!(figure.panels[0].marks.iter().all(|mark| !mark.points.is_empty()));
    }
}
