//! Walls as lines in the plane that is drawn.

use super::flow::in_plane;
use crate::column::ColumnSize;
use crate::records::StageRecord;
use crate::scene::boundaries::MotionSpec;
use crate::scene::{Change, Dimension, Scene, WallSpec};
use granular_core::units::Length;
use granular_io::figure::GrainPanel;
use std::f64::consts::TAU;

/// A line between two points, in millimetres.
pub(super) type Line = [[f64; 2]; 2];
/// Lower left and upper right corner, in millimetres.
pub(super) type Reach = [[f64; 2]; 2];

/// Corners of the outline of a tube that is seen along its axis.
const ROUND: usize = 120;
/// Components of the normal of a plane below which, as a share of its length, it is seen edge on.
const EDGE_ON: f64 = 1e-6;

/// The walls of a scene.
#[derive(Clone, Copy)]
pub(super) struct Walls<'a> {
    pub(super) scene: &'a Scene,
    pub(super) column: Option<ColumnSize>,
    /// Stages that were begun: walls open with them.
    pub(super) records: &'a [StageRecord],
}

impl Walls<'_> {
    /// Adds the walls to panels of frames at these simulated times \[s\].
    pub(super) fn add(&self, panels: &mut [GrainPanel], times: &[f64]) {
        let reach = reach(panels);
        for (panel, &time) in panels.iter_mut().zip(times) {
            panel.walls = self.lines(time, reach);
        }
    }

    /// The walls that stand at a simulated time \[s\]. Those without end are drawn as far as `reach`. Walls that have moved
    /// are left out: files do not hold where they are.
    pub(super) fn lines(&self, time: f64, reach: Reach) -> Vec<Line> {
        let stands = |wall: &&WallSpec| !self.is_open(wall, time) && (stays(wall) || time <= 0.0);
        let walls: Vec<&WallSpec> = self.scene.walls.iter().filter(stands).collect();
        self.lines_of(&walls, reach)
    }

    /// Some walls as they stand at the start.
    pub(super) fn lines_of(&self, walls: &[&WallSpec], reach: Reach) -> Vec<Line> {
        let mut lines: Vec<Line> = walls.iter().flat_map(|wall| self.bounded(wall)).collect();
        let [mut low, mut high] = around(reach, &lines);
        // Walls that stand beside the grains are to be seen also where these do not reach them.
        for wall in walls {
            match wall {
                WallSpec::Floor { .. } => low[1] = low[1].min(0.0),
                WallSpec::Left { .. } => low[0] = low[0].min(0.0),
                WallSpec::Right { .. } | WallSpec::Gate { .. } => high[0] = high[0].max(self.right()),
                _ => {}
            }
        }
        lines.extend(walls.iter().flat_map(|wall| self.unbounded(wall, [low, high])));
        lines
    }

    /// Between which x walls that have ends lie \[m\]; none without any.
    pub(super) fn ends(&self) -> Option<[f64; 2]> {
        let lines = self.scene.walls.iter().flat_map(|wall| self.bounded(wall));
        let [low, high] = lines
            .flatten()
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], end| [low.min(end[0]), high.max(end[0])]);
        (low <= high).then_some([1e-3 * low, 1e-3 * high])
    }

    /// Whether a wall is open. A frame at the very start of a stage is of the state before it.
    fn is_open(&self, wall: &WallSpec, time: f64) -> bool {
        let begun = self.records.iter().filter(|record| record.start < time);
        let mut open = false;
        for name in begun.map(|record| record.name.as_str()) {
            open |= wall.opens() == Some(name);
            let stage = self.scene.stages.iter().find(|stage| stage.name == name);
            for change in stage.iter().flat_map(|stage| &stage.changes) {
                match change {
                    Change::Open(other) if other == wall.name() => open = true,
                    Change::Close(other) if other == wall.name() => open = false,
                    _ => {}
                }
            }
        }
        open
    }

    /// Where the wall right of a column is.
    fn right(&self) -> f64 {
        1e3 * self.column.map_or(0.0, |column| column.width)
    }

    fn place(&self, at: &[Length]) -> [f64; 2] {
        in_plane(self.scene, std::array::from_fn(|axis| at.get(axis).map_or(0.0, |x| x.value())))
    }

    /// Lines of a wall that has ends.
    fn bounded(&self, wall: &WallSpec) -> Vec<Line> {
        match wall {
            WallSpec::Segment { from, to, .. } => vec![[self.place(from), self.place(to)]],
            WallSpec::Chain { points, closed, .. } => {
                let points: Vec<[f64; 2]> = points.iter().map(|point| self.place(point)).collect();
                joined(&points, *closed)
            }
            WallSpec::Block { low, high, .. } | WallSpec::Box { low, high, .. } => {
                rectangle(self.place(low), self.place(high))
            }
            WallSpec::HeldGrains { low, high, diameter, .. } => {
                let half = 500.0 * diameter.value();
                let ([a, b], [c, d]) = (self.place(low), self.place(high));
                rectangle([a - half, b - half], [c + half, d + half])
            }
            WallSpec::Tube { from, to, radius, .. } => {
                tube(self.place(from), self.place(to), 1e3 * radius.value())
            }
            WallSpec::Circle { centre, radius, .. } => {
                let centre = self.place(centre);
                tube(centre, centre, 1e3 * radius.value())
            }
            WallSpec::Mesh { .. } => self.cut(wall),
            _ => vec![],
        }
    }

    /// Lines of a wall without end, within corners.
    fn unbounded(&self, wall: &WallSpec, [low, high]: Reach) -> Vec<Line> {
        let upright = |x: f64| [[x, low[1]], [x, high[1]]];
        match wall {
            WallSpec::Floor { .. } => vec![[[low[0], 0.0], [high[0], 0.0]]],
            WallSpec::Left { .. } => vec![upright(0.0)],
            WallSpec::Gate { .. } if self.column.is_some_and(|column| column.round.is_some()) => {
                vec![upright(-self.right()), upright(self.right())]
            }
            WallSpec::Right { .. } | WallSpec::Gate { .. } => vec![upright(self.right())],
            WallSpec::Plane { point, normal, .. } => {
                self.plane(point, normal, [low, high]).into_iter().collect()
            }
            _ => vec![],
        }
    }

    /// The line in which a plane is seen, when it is seen edge on.
    pub(super) fn plane(&self, point: &[Length], normal: &[f64], reach: Reach) -> Option<Line> {
        let length = normal.iter().map(|n| n * n).sum::<f64>().sqrt();
        let of = |axis: usize| normal.get(axis).copied().unwrap_or(0.0) / length;
        let [n, across, up] = match self.scene.dimension {
            Dimension::Plane => [of(0), 0.0, of(1)],
            Dimension::Space => [of(0), of(1), of(2)],
        };
        if across.is_nan() || across.abs() > EDGE_ON {
            return None;
        }
        within(self.place(point), [up, -n], reach)
    }

    /// Where the triangles of a mesh meet the plane in the middle of it.
    fn cut(&self, wall: &WallSpec) -> Vec<Line> {
        let WallSpec::Mesh { file, unit, at, .. } = wall else { return vec![] };
        // That it can be read the check has seen; without it there is nothing to draw.
        let Ok(triangles) = granular_io::read_stl(&self.scene.folder.join(file)) else { return vec![] };
        let ends = triangles
            .as_flattened()
            .iter()
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], p| [low.min(p[1]), high.max(p[1])]);
        // Not through the corners of a regular mesh.
        let y = ends[0] + (ends[1] - ends[0]) * 0.500_123;
        let shift = |axis: usize| at.get(axis).map_or(0.0, |x| x.value());
        let place = |p: [f64; 3]| {
            in_plane(self.scene, std::array::from_fn(|axis| p[axis] * unit.value() + shift(axis)))
        };
        let mut lines = Vec::new();
        for [a, b, c] in triangles {
            let meets = [[a, b], [b, c], [c, a]].into_iter().filter_map(|[from, to]: [[f64; 3]; 2]| {
                let (before, after) = (from[1] - y, to[1] - y);
                let share = before / (before - after);
                let at = std::array::from_fn(|k| from[k] + share * (to[k] - from[k]));
                (before * after < 0.0).then(|| place(at))
            });
            if let [from, to] = meets.collect::<Vec<_>>()[..] {
                lines.push([from, to]);
            }
        }
        lines
    }
}

/// Whether a wall looks the same at any time: one at rest, and a drum.
fn stays(wall: &WallSpec) -> bool {
    match (wall, wall.moves()) {
        (_, None) => true,
        (WallSpec::Circle { centre, .. }, Some(MotionSpec::Rotate { about, .. })) => about == centre,
        _ => false,
    }
}

/// What the grains and contacts of all panels take up, with some room.
fn reach(panels: &[GrainPanel]) -> Reach {
    let (mut low, mut high) = ([0.0_f64; 2], [0.0_f64; 2]);
    let mut add = |[x, y]: [f64; 2]| {
        (low, high) = ([low[0].min(x), low[1].min(y)], [high[0].max(x), high[1].max(y)]);
    };
    for panel in panels {
        for grain in &panel.grains {
            let ([x, y], r) = (grain.center, grain.radius);
            [[x - r, y - r], [x + r, y + r]].into_iter().for_each(&mut add);
        }
        panel.chains.iter().flat_map(|chain| [chain.from, chain.to]).for_each(&mut add);
    }
    // Beside a wall at x = 0, and on a floor, grains overlap it a little.
    let beyond = |low: f64, high: f64| if low > -0.01 * (high - low) { 0.0 } else { low };
    let (left, bottom) = (beyond(low[0], high[0]), beyond(low[1], high[1]));
    let (wide, tall) = (high[0] - left, high[1] - bottom);
    let left = if left < 0.0 { left - 0.02 * wide } else { left };
    [[left, bottom], [high[0] + 0.02 * wide, high[1] + 0.05 * tall]]
}

/// Corners around these and all ends of lines.
fn around([low, high]: Reach, lines: &[Line]) -> Reach {
    lines.iter().flatten().fold([low, high], |[low, high], end| {
        [
            std::array::from_fn(|k: usize| low[k].min(end[k])),
            std::array::from_fn(|k: usize| high[k].max(end[k])),
        ]
    })
}

/// Lines from point to point.
pub(super) fn joined(points: &[[f64; 2]], closed: bool) -> Vec<Line> {
    let closing = points.last().zip(points.first()).filter(|_| closed);
    points.windows(2).map(|pair| (&pair[0], &pair[1])).chain(closing).map(|(a, b)| [*a, *b]).collect()
}

fn rectangle([a, b]: [f64; 2], [c, d]: [f64; 2]) -> Vec<Line> {
    joined(&[[a, b], [c, b], [c, d], [a, d]], true)
}

/// A tube: its sides, or a circle where it is seen along its axis.
fn tube(from: [f64; 2], to: [f64; 2], radius: f64) -> Vec<Line> {
    let along = [to[0] - from[0], to[1] - from[1]];
    let length = along[0].hypot(along[1]);
    if length <= 1e-9 * radius {
        let corner = |k: usize| {
            let (sine, cosine) = (TAU * k as f64 / ROUND as f64).sin_cos();
            [from[0] + radius * cosine, from[1] + radius * sine]
        };
        return joined(&(0..ROUND).map(corner).collect::<Vec<_>>(), true);
    }
    let side = [-along[1] / length * radius, along[0] / length * radius];
    let beside = |sign: f64| [from, to].map(|end| [end[0] + sign * side[0], end[1] + sign * side[1]]);
    vec![beside(1.0), beside(-1.0)]
}

/// The part of a line without end that lies within corners.
fn within(point: [f64; 2], direction: [f64; 2], [low, high]: Reach) -> Option<Line> {
    let (mut first, mut last) = (f64::NEG_INFINITY, f64::INFINITY);
    for k in 0..2 {
        if direction[k].abs() < EDGE_ON {
            if !(low[k]..=high[k]).contains(&point[k]) {
                return None;
            }
            continue;
        }
        let ends = [low[k], high[k]].map(|end| (end - point[k]) / direction[k]);
        (first, last) = (first.max(ends[0].min(ends[1])), last.min(ends[0].max(ends[1])));
    }
    let at = |share: f64| [point[0] + share * direction[0], point[1] + share * direction[1]];
    (first < last && first.is_finite() && last.is_finite()).then(|| [at(first), at(last)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene_file::SceneText;
    use granular_io::figure::Grain;

    fn scene(walls: &str) -> Scene {
        let (name, text) = crate::TEMPLATES.iter().find(|(name, _)| *name == "column-collapse").unwrap();
        let (head, tail) = text.split_once("walls: [").unwrap();
        let (_, tail) = tail.split_once("],").unwrap();
        SceneText::new(*name, format!("{head}walls: [{walls}],{tail}")).parse().unwrap()
    }

    fn record(name: &str, start: f64) -> StageRecord {
        StageRecord { name: name.to_owned(), start, front: f64::NAN, height: f64::NAN, push: None }
    }

    /// Lines of these walls beside a column of 50 mm, around grains that take up 100 mm x 100 mm.
    fn lines(walls: &str, time: f64) -> Vec<Line> {
        let scene = scene(walls);
        let column = Some(ColumnSize { width: 0.05, height: 0.04, depth: None, round: None });
        let records = [record("settle", 0.0), record("collapse", 0.5)];
        let walls = Walls { scene: &scene, column, records: &records };
        let grains = vec![Grain { center: [50.0, 50.0], radius: 50.0, value: 0.0 }];
        let mut panels = vec![GrainPanel { grains, ..GrainPanel::default() }];
        walls.add(&mut panels, &[time]);
        panels.remove(0).walls
    }

    #[test]
    fn all_walls_beside_a_column_are_drawn() {
        let found =
            lines("Floor(material: \"wall\"), Left(material: \"wall\"), Right(material: \"wall\")", 0.2);
        let floor = [[0.0, 0.0], [102.0, 0.0]];
        assert_eq!(found, [floor, [[0.0, 0.0], [0.0, 105.0]], [[50.0, 0.0], [50.0, 105.0]]]);
    }

    #[test]
    fn a_gate_stands_until_the_stage_that_opens_it() {
        let gate = "Gate(material: \"wall\", opens: \"collapse\")";
        assert_eq!(lines(gate, 0.5), [[[50.0, 0.0], [50.0, 105.0]]]);
        assert_eq!(lines(gate, 0.51), Vec::<Line>::new());
        let slide = "Segment(name: \"s\", material: \"wall\", from: [\"0 m\", \"1 mm\"], to: [\"4 mm\", \"1 mm\"], \
                     opens: \"collapse\")";
        assert_eq!((lines(slide, 0.1), lines(slide, 0.6)), (vec![[[0.0, 1.0], [4.0, 1.0]]], vec![]));
    }

    #[test]
    fn planes_are_drawn_as_far_as_grains_reach_and_blocks_by_their_edges() {
        let slope = "Plane(name: \"p\", material: \"wall\", point: [\"0 m\", \"0 m\"], normal: [-1, 1])";
        let [[from, to]] = lines(slope, 0.1)[..] else { panic!("one line") };
        let off = [from[0], from[1], to[0] - 102.0, to[1] - 102.0];
        assert!(off.iter().all(|off| off.abs() < 1e-9), "{from:?} {to:?}");
        let block =
            "Block(name: \"b\", material: \"wall\", low: [\"1 mm\", \"2 mm\"], high: [\"3 mm\", \"4 mm\"])";
        let edges = [[1.0, 2.0], [3.0, 2.0], [3.0, 4.0], [1.0, 4.0]];
        assert_eq!(lines(block, 0.1), joined(&edges, true));
        let tube = "Tube(name: \"t\", material: \"wall\", from: [\"0 m\", \"0 m\"], to: [\"8 mm\", \"0 m\"], \
                    radius: \"2 mm\")";
        assert_eq!(lines(tube, 0.1), [[[0.0, 2.0], [8.0, 2.0]], [[0.0, -2.0], [8.0, -2.0]]]);
        let drum = "Circle(name: \"d\", material: \"wall\", centre: [\"3 mm\", \"1 mm\"], radius: \"2 mm\", \
                    moves: Rotate(about: [\"3 mm\", \"1 mm\"], spin: [1]))";
        let outline = lines(drum, 0.1);
        assert_eq!(outline.len(), ROUND);
        let off = |[x, y]: [f64; 2]| ((x - 3.0).hypot(y - 1.0) - 2.0).abs();
        assert!(outline.iter().flatten().all(|end| off(*end) < 1e-12));
    }
}
