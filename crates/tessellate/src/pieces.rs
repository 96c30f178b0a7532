//! Edges cut to a convex domain.

use crate::beach::NONE;
use crate::curve::{Beyond, Curve};
use crate::diagram::Diagram;
use crate::domain::{Domain, Line};
use granular_core::glam::DVec2;

/// An end of a piece of an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum End {
    /// A vertex of the diagram.
    Vertex(u32),
    /// A crossing with the boundary of the domain.
    Crossing(u32),
}

/// A part of an edge within the domain, in the direction of its first half-edge.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece {
    pub(crate) edge: u32,
    pub(crate) ends: [End; 2],
}

/// Where an edge meets the boundary of the domain.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Crossing {
    /// Number of the side, and distance from its start.
    pub(crate) side: usize,
    pub(crate) at: f64,
    pub(crate) point: DVec2,
    /// Site whose cell ends here on a way counter-clockwise along the boundary, and the one whose cell begins.
    pub(crate) owners: [u32; 2],
}

/// An end while cutting: the parameter of an edge, and a vertex or the side that cuts.
#[derive(Clone, Copy, Debug)]
enum Cut {
    /// An end of the edge; the vertex is `NONE` at infinity.
    Own(u32),
    /// A side of the domain.
    Side(usize),
}

type Interval = [(f64, Cut); 2];

/// All parts of edges within the domain and their crossings with its boundary.
pub(crate) fn pieces(diagram: &Diagram, domain: &Domain) -> (Vec<Piece>, Vec<Crossing>) {
    let depths: Vec<f64> = diagram.vertices().iter().map(|vertex| domain.depth(vertex.position)).collect();
    let (mut pieces, mut crossings) = (Vec::with_capacity(diagram.edge_count()), Vec::new());
    for edge in 0..diagram.edge_count() as u32 {
        let [from, to] = diagram.ends(edge);
        if within(diagram, edge, &depths) {
            pieces.push(Piece { edge, ends: [End::Vertex(from), End::Vertex(to)] });
            continue;
        }
        let curve = diagram.curve(edge);
        for interval in cut(diagram, domain, &curve, [from, to]) {
            let owners = diagram.owners(edge);
            let ends = [0, 1].map(|k| match interval[k] {
                (_, Cut::Own(vertex)) => End::Vertex(vertex),
                (eta, Cut::Side(side)) => {
                    let line = &domain.sides()[side];
                    let at = (curve.point(eta) - line.from).dot(line.along).clamp(0.0, line.length);
                    // Where the edge leaves, its left site follows counter-clockwise.
                    let owners = if k == 1 { [owners[1], owners[0]] } else { owners };
                    crossings.push(Crossing { side, at, point: line.at(at), owners });
                    End::Crossing(crossings.len() as u32 - 1)
                }
            });
            pieces.push(Piece { edge, ends });
        }
    }
    (pieces, crossings)
}

/// Whether an edge is certain to lie within the domain: it turns by less than a right angle, so it stays in
/// the disk about its chord, and both its ends are deep enough.
#[inline(always)]
fn within(diagram: &Diagram, edge: u32, depths: &[f64]) -> bool {
    let [from, to] = diagram.ends(edge);
    if from == NONE || to == NONE {
        return false;
    }
    let depth = depths[from as usize].min(depths[to as usize]);
    if depth.is_nan() || depth <= 0.0 {
        return false;
    }
    let [a, b] = [from, to].map(|vertex| diagram.vertices()[vertex as usize].position);
    let [left, right] = diagram.owners(edge).map(|site| site as usize);
    let gap = (diagram.position(left) - diagram.position(right)).length_squared();
    let step = diagram.radius(left) - diagram.radius(right);
    // A branch with a <= b, that is 2 a^2 <= c^2, turns by at most a right angle.
    2.0 * step * step <= gap && (a - b).length_squared() < depth * depth
}

/// The parts of a curve between two vertices that lie in the domain.
fn cut(diagram: &Diagram, domain: &Domain, curve: &Curve, ends: [u32; 2]) -> Vec<Interval> {
    let own = |vertex: u32, infinity: f64| match vertex {
        NONE => (infinity, Cut::Own(NONE)),
        vertex => (curve.parameter(diagram.vertices()[vertex as usize].position), Cut::Own(vertex)),
    };
    let mut intervals = vec![[own(ends[0], f64::NEG_INFINITY), own(ends[1], f64::INFINITY)]];
    let mut inside = Vec::new();
    for (number, side) in domain.sides().iter().enumerate() {
        let beyond = curve.beyond(side.from, side.normal);
        for interval in intervals.drain(..) {
            cut_at_line(diagram, &beyond, (number, side), interval, &mut inside);
        }
        std::mem::swap(&mut intervals, &mut inside);
    }
    // What is still there at infinity runs along a side, to rounding.
    intervals.retain(|interval| interval.iter().all(|(_, cut)| !matches!(cut, Cut::Own(NONE))));
    intervals
}

/// Adds the parts of an interval that are not beyond a side.
///
/// Rounding may put the roots next to an end on its wrong side. What counts is where the middle of each
/// stretch lies, and for a vertex its place: both are the same for whoever asks, so that cells stay closed.
fn cut_at_line(
    diagram: &Diagram,
    beyond: &Beyond,
    (number, side): (usize, &Line),
    interval: Interval,
    inside: &mut Vec<Interval>,
) {
    let [first, last] = interval;
    let within = |eta: &f64| first.0 < *eta && *eta < last.0;
    let mut ends: Vec<f64> = vec![first.0];
    ends.extend(beyond.roots().into_iter().flatten().filter(within));
    ends.push(last.0);
    let mut open = (!outside(diagram, beyond, side, first)).then_some(first);
    let mut change = |out: bool, end: (f64, Cut)| match (out, open.take()) {
        (true, Some(begin)) => inside.push([begin, end]),
        (false, None) => open = Some(end),
        (_, before) => open = before,
    };
    for pair in ends.windows(2) {
        change(beyond.at(between(pair[0], pair[1])), (pair[0], Cut::Side(number)));
    }
    change(outside(diagram, beyond, side, last), (last.0, Cut::Side(number)));
    change(true, last);
}

/// Whether an end is beyond a side.
fn outside(diagram: &Diagram, beyond: &Beyond, side: &Line, (eta, cut): (f64, Cut)) -> bool {
    match cut {
        Cut::Own(vertex) if vertex != NONE => side.beyond(diagram.vertices()[vertex as usize].position) > 0.0,
        _ => beyond.at(eta),
    }
}

/// A parameter between two, which may be infinite.
fn between(a: f64, b: f64) -> f64 {
    match (a.is_finite(), b.is_finite()) {
        (true, true) => 0.5 * (a + b),
        (true, false) => a + 1.0,
        (false, true) => b - 1.0,
        (false, false) => 0.0,
    }
}
