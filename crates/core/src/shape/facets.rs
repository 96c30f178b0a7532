//! Surfaces made of many parts: chains of segments, meshes of triangles, and grains that are held.
//!
//! All parts of a surface have as many corners: one (a ball about it), two or three. A tree of boxes finds the
//! parts near a point.

use crate::dim::{Dim, Linear, Vector};
use crate::setup_error::SetupError;

/// Parts in one leaf of the tree.
const LEAF: usize = 4;

/// A surface of many parts.
#[derive(Clone, Debug, PartialEq)]
pub struct Facets<D: Dim> {
    /// Corners of all parts, one part after the other \[m\].
    corners: Vec<D::Vec>,
    /// Corners of one part.
    each: usize,
    /// Radii of the balls \[m\]; empty unless a part is a ball.
    radii: Vec<f64>,
    nodes: Vec<Node<D>>,
    /// Parts in the order of the leaves.
    order: Vec<u32>,
}

/// A box of the tree, in the order of a walk that goes down first.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Node<D: Dim> {
    low: D::Vec,
    high: D::Vec,
    /// The next box when this one is too far.
    skip: u32,
    /// Parts of a leaf in `order`; none for an inner box.
    from: u32,
    count: u32,
}

impl<D: Dim> Node<D> {
    fn squared_distance(&self, point: D::Vec) -> f64 {
        (point - point.max(self.low).min(self.high)).length_squared()
    }
}

impl<D: Dim> Facets<D> {
    /// Parts with `each` corners \[m\]: 2 for segments, 3 for triangles.
    ///
    /// # Errors
    /// When there is none, corners are left over, one is not finite, or a part has no extent.
    ///
    /// # Panics
    /// When `each` is neither 2 nor 3.
    pub fn new(corners: Vec<D::Vec>, each: usize) -> Result<Self, SetupError> {
        assert!((2..=3).contains(&each), "a part is a segment or a triangle");
        if !corners.len().is_multiple_of(each) {
            let allowed = if each == 3 { "three for each triangle" } else { "two for each segment" };
            return Err(SetupError::new("number of corners", corners.len() as f64, allowed));
        }
        let facets = Self { corners, each, radii: Vec::new(), nodes: Vec::new(), order: Vec::new() };
        for part in 0..facets.len() {
            let extent = facets.extent(part);
            // A sliver has no inside to speak of, but its edges are as good as any.
            if !(extent.is_finite() && extent > 0.0) {
                return Err(SetupError::new(format!("extent of part {part}"), extent, "positive and finite"));
            }
        }
        facets.grown()
    }

    /// Balls, each with its centre and radius \[m\].
    ///
    /// # Errors
    /// When there is none, or one has no finite position and positive radius.
    pub fn balls(balls: &[(D::Vec, f64)]) -> Result<Self, SetupError> {
        for (part, (centre, radius)) in balls.iter().enumerate() {
            if !(centre.is_finite() && radius.is_finite() && *radius > 0.0) {
                let what = format!("radius of grain {part}");
                return Err(SetupError::new(what, *radius, "positive and finite, at a finite position"));
            }
        }
        Self {
            corners: balls.iter().map(|ball| ball.0).collect(),
            each: 1,
            radii: balls.iter().map(|ball| ball.1).collect(),
            nodes: Vec::new(),
            order: Vec::new(),
        }
        .grown()
    }

    /// Number of parts.
    pub fn len(&self) -> usize {
        self.corners.len() / self.each
    }

    /// Whether there are no parts: never, once it is built.
    pub fn is_empty(&self) -> bool {
        self.corners.is_empty()
    }

    /// Corners of a part \[m\].
    pub fn corners(&self, part: usize) -> &[D::Vec] {
        &self.corners[part * self.each..(part + 1) * self.each]
    }

    /// Radius of a ball \[m\]; `None` for a chain or mesh.
    pub fn radius(&self, part: usize) -> Option<f64> {
        self.radii.get(part).copied()
    }

    /// Corners of a box \[m\] around all parts.
    pub fn bounds(&self) -> (D::Vec, D::Vec) {
        self.bounds_of(&self.order)
    }

    /// Whether parts are balls, each of which is a body of its own.
    pub fn are_balls(&self) -> bool {
        !self.radii.is_empty()
    }

    /// Length of the longest side of a part.
    fn extent(&self, part: usize) -> f64 {
        let corners = self.corners(part);
        let finite = corners.iter().all(|corner| corner.is_finite());
        let longest =
            corners.iter().skip(1).map(|&corner| (corner - corners[0]).length()).fold(0.0, f64::max);
        if finite { longest } else { f64::NAN }
    }

    /// Distance of a point from a part \[m\] and the unit normal from the part to the point.
    #[inline]
    pub fn distance_to(&self, part: usize, point: D::Vec) -> (f64, D::Vec) {
        let arm = point - nearest_point::<D>(self.corners(part), point);
        let length = arm.length();
        let normal = if length > 0.0 { arm * (1.0 / length) } else { D::Vec::ZERO };
        (length - self.radius(part).unwrap_or(0.0), normal)
    }

    /// Distance of a point from the surface \[m\] and the unit normal from the surface to the point.
    pub fn distance(&self, point: D::Vec) -> (f64, D::Vec) {
        let mut nearest = (f64::INFINITY, D::Vec::ZERO);
        let mut at = 0;
        while let Some(node) = self.nodes.get(at) {
            if node.squared_distance(point) >= nearest.0.max(0.0).powi(2) {
                at = node.skip as usize;
                continue;
            }
            for &part in self.parts_of(node) {
                let found = self.distance_to(part as usize, point);
                if found.0 < nearest.0 {
                    nearest = found;
                }
            }
            at += 1;
        }
        nearest
    }

    /// Calls `visit` for every part whose box is nearer to a point than `reach` \[m\].
    pub fn visit_near(&self, point: D::Vec, reach: f64, mut visit: impl FnMut(u32)) {
        let mut at = 0;
        while let Some(node) = self.nodes.get(at) {
            if node.squared_distance(point) >= reach * reach {
                at = node.skip as usize;
                continue;
            }
            self.parts_of(node).iter().for_each(|&part| visit(part));
            at += 1;
        }
    }

    fn parts_of(&self, node: &Node<D>) -> &[u32] {
        &self.order[node.from as usize..(node.from + node.count) as usize]
    }

    fn grown(mut self) -> Result<Self, SetupError> {
        let count = self.len();
        if count == 0 || u32::try_from(count).is_err() {
            return Err(SetupError::new("number of parts", count as f64, "at least one, and below 2^32"));
        }
        let mut order: Vec<u32> = (0..count as u32).collect();
        self.grow(&mut order, 0);
        self.order = order;
        Ok(self)
    }

    /// Appends the box of some parts and all boxes below it. `offset` is where the parts are in the order.
    fn grow(&mut self, parts: &mut [u32], offset: usize) {
        let (low, high) = self.bounds_of(parts);
        let place = self.nodes.len();
        let leaf = parts.len() <= LEAF;
        let count = if leaf { parts.len() as u32 } else { 0 };
        self.nodes.push(Node { low, high, skip: 0, from: offset as u32, count });
        if !leaf {
            let extent = high - low;
            let longer = |a: usize, b: usize| if extent.component(b) > extent.component(a) { b } else { a };
            let axis = (1..D::N).fold(0, longer);
            let centre =
                |part: u32| self.corners(part as usize).iter().fold(0.0, |sum, c| sum + c.component(axis));
            let half = parts.len() / 2;
            parts.sort_by(|&a, &b| centre(a).total_cmp(&centre(b)).then(a.cmp(&b)));
            let (left, right) = parts.split_at_mut(half);
            self.grow(left, offset);
            self.grow(right, offset + half);
        }
        self.nodes[place].skip = self.nodes.len() as u32;
    }

    fn bounds_of(&self, parts: &[u32]) -> (D::Vec, D::Vec) {
        let far = D::Vec::splat(f64::INFINITY);
        let mut bounds = (far, -far);
        for &part in parts {
            let radius = self.radius(part as usize).unwrap_or(0.0);
            let margin = D::Vec::splat(radius);
            for &corner in self.corners(part as usize) {
                bounds = (bounds.0.min(corner - margin), bounds.1.max(corner + margin));
            }
        }
        bounds
    }
}

/// The point of a part that is nearest to `point`.
#[inline]
fn nearest_point<D: Dim>(corners: &[D::Vec], point: D::Vec) -> D::Vec {
    match *corners {
        [a, b] => nearest_on_segment::<D>(a, b, point),
        [a, b, c] => nearest_on_triangle::<D>(a, b, c, point),
        _ => corners[0],
    }
}

#[inline]
fn nearest_on_segment<D: Dim>(from: D::Vec, to: D::Vec, point: D::Vec) -> D::Vec {
    let along = to - from;
    let share = (point - from).dot(along) / along.length_squared();
    // Written from the nearer end: a point beside either end is as exact as one beside the other.
    if share <= 0.5 {
        from + along * share.max(0.0)
    } else {
        to - along * ((to - point).dot(along) / along.length_squared()).max(0.0)
    }
}

/// By the regions of the triangle in which a point is nearest to a corner, an edge or the inside
/// \[Ericson2005, section 5.1.5\].
fn nearest_on_triangle<D: Dim>(a: D::Vec, b: D::Vec, c: D::Vec, point: D::Vec) -> D::Vec {
    let (ab, ac) = (b - a, c - a);
    let normal_of = |arm: D::Vec| (ab.dot(arm), ac.dot(arm));
    let (d1, d2) = normal_of(point - a);
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    let (d3, d4) = normal_of(point - b);
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    let (d5, d6) = normal_of(point - c);
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    let (va, vb, vc) = (d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2);
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return nearest_on_segment::<D>(a, b, point);
    }
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return nearest_on_segment::<D>(a, c, point);
    }
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        return nearest_on_segment::<D>(b, c, point);
    }
    let total = va + vb + vc;
    // A sliver without area: one of its edges is as near as anything.
    if total <= 0.0 {
        let edges = [(a, b), (a, c), (b, c)].map(|(from, to)| nearest_on_segment::<D>(from, to, point));
        let nearer = |x: D::Vec, y: D::Vec| {
            if (point - y).length_squared() < (point - x).length_squared() { y } else { x }
        };
        return nearer(nearer(edges[0], edges[1]), edges[2]);
    }
    a + ab * (vb / total) + ac * (vc / total)
}

#[cfg(test)]
mod tests;
