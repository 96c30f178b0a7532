//! Cells: what each site owns of a domain.

use crate::curve::Curve;
use crate::diagram::Diagram;
use crate::domain::Domain;
use crate::pieces::{Crossing, End, Piece, pieces};
use granular_core::glam::DVec2;
use std::sync::OnceLock;

/// The cells of a diagram within a domain.
#[derive(Clone, Debug)]
pub struct Cells<'a> {
    diagram: &'a Diagram,
    domain: &'a Domain,
    areas: Vec<f64>,
    pieces: Vec<Piece>,
    crossings: Vec<Crossing>,
    walls: Vec<Wall>,
    /// What bounds each cell, listed when it is first asked for: areas do not need it.
    bounds: OnceLock<Bounds>,
}

/// Pieces of each cell and stretches of wall, from `starts[i]` to `starts[i + 1]`.
#[derive(Clone, Debug)]
struct Bounds {
    starts: Vec<u32>,
    parts: Vec<Part>,
}

/// A stretch of the boundary of the domain, from crossing to crossing; all of it without any.
#[derive(Clone, Copy, Debug)]
struct Wall {
    site: u32,
    between: Option<[u32; 2]>,
    /// Corners that it passes.
    corners: u32,
}

/// The begin of a loop without one.
const NOWHERE: End = End::Vertex(u32::MAX);

/// What bounds a cell.
#[derive(Clone, Copy, Debug)]
enum Part {
    /// A piece of an edge; `true` if the cell is that of its second half-edge.
    Piece(u32, bool),
    Wall(u32),
}

/// A side of a cell; the cell is at the left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Side {
    /// The site beyond; none at the boundary of the domain.
    pub neighbour: Option<usize>,
    /// Where it begins.
    pub from: DVec2,
    /// Where it ends.
    pub to: DVec2,
    curve: Option<(Curve, bool)>,
}

impl Side {
    /// Whether it is straight, within a domain or between disks of one size.
    pub fn is_straight(&self) -> bool {
        self.curve.is_none_or(|(curve, _)| curve.is_straight())
    }

    pub(crate) fn curve(&self) -> Option<&Curve> {
        self.curve.as_ref().map(|(curve, _)| curve)
    }

    /// The point after a share of the side, 0 at its begin and 1 at its end.
    pub fn point(&self, share: f64) -> DVec2 {
        match &self.curve {
            Some((curve, _)) if !curve.is_straight() && share > 0.0 && share < 1.0 => {
                let [first, last] = [self.from, self.to].map(|point| curve.parameter(point));
                curve.point(first + (last - first) * share)
            }
            _ => self.from.lerp(self.to, share),
        }
    }

    /// Area between the side and its chord, positive where the cell has more than the polygon of its corners.
    pub fn area_beyond_chord(&self) -> f64 {
        match self.curve {
            Some((curve, false)) => curve.area_beyond_chord(self.from, self.to),
            Some((curve, true)) => -curve.area_beyond_chord(self.to, self.from),
            None => 0.0,
        }
    }
}

/// Crossings in an order in which each begins with the owner that the last one ends with, from `start` on; those that
/// fit nowhere come last (the way of Hierholzer to an Euler trail).
fn trail(crossings: &[u32], start: u32, owners: impl Fn(u32) -> [u32; 2]) -> Vec<u32> {
    let mut left = crossings.to_vec();
    let (mut open, mut done): (Vec<u32>, Vec<u32>) = (Vec::new(), Vec::new());
    let mut owner = start;
    loop {
        if let Some(next) = left.iter().position(|&k| owners(k)[0] == owner) {
            open.push(left.remove(next));
        } else if let Some(closed) = open.pop() {
            done.push(closed);
        } else {
            break;
        }
        owner = open.last().map_or(start, |&k| owners(k)[1]);
    }
    done.reverse();
    done.extend(left);
    done
}

impl<'a> Cells<'a> {
    pub(crate) fn new(diagram: &'a Diagram, domain: &'a Domain) -> Self {
        let (pieces, crossings) = pieces(diagram, domain);
        let mut cells = Self {
            diagram,
            domain,
            areas: vec![0.0; diagram.len()],
            pieces,
            crossings,
            walls: Vec::new(),
            bounds: OnceLock::new(),
        };
        cells.lay_walls();
        cells.measure();
        cells
    }

    /// Shares out the boundary of the domain.
    fn lay_walls(&mut self) {
        let count = self.crossings.len();
        if count == 0 {
            let corner = self.domain.sides()[0].from;
            let site = self.diagram.nearest(corner) as u32;
            let corners = self.domain.sides().len() as u32;
            self.walls.push(Wall { site, between: None, corners });
            return;
        }
        let mut order: Vec<u32> = (0..count as u32).collect();
        let place = |k: u32| (self.crossings[k as usize].side, self.crossings[k as usize].at);
        order.sort_by(|&a, &b| {
            let ((side_a, at_a), (side_b, at_b)) = (place(a), place(b));
            side_a.cmp(&side_b).then(at_a.total_cmp(&at_b)).then(a.cmp(&b))
        });
        let start = self.after_widest_gap(&order);
        let mut turned = vec![false; count];
        order[..start].iter().for_each(|&k| turned[k as usize] = true);
        order.rotate_left(start);
        self.chain(&mut order);
        let sides = self.domain.sides().len();
        let side = |k: u32| place(k).0 + if turned[k as usize] { sides } else { 0 };
        self.walls.extend((0..count).map(|k| {
            let (from, to) = (order[k], order[(k + 1) % count]);
            let last = if k + 1 == count { side(to) + sides } else { side(to) };
            let corners = last.saturating_sub(side(from)) as u32;
            Wall { site: self.crossings[from as usize].owners[1], between: Some([from, to]), corners }
        }));
    }

    /// The place in the order of crossings after the widest gap between two of them, around the domain.
    fn after_widest_gap(&self, order: &[u32]) -> usize {
        let mut around = 0.0;
        let mut starts = Vec::new();
        for side in self.domain.sides() {
            starts.push(around);
            around += side.length;
        }
        let way = |k: u32| starts[self.crossings[k as usize].side] + self.crossings[k as usize].at;
        let mut widest = (way(order[0]) + around - way(order[order.len() - 1]), 0);
        for k in 1..order.len() {
            let gap = way(order[k]) - way(order[k - 1]);
            if gap > widest.0 {
                widest = (gap, k);
            }
        }
        widest.1
    }

    /// Crossings that coincide to rounding are put in the order in which owners follow one another.
    fn chain(&self, order: &mut [u32]) {
        let size = self.domain.sides().iter().map(|side| side.length).sum::<f64>();
        let scale = self.domain.corners().fold(size, |most, p| most.max(p.x.abs()).max(p.y.abs()));
        let owners = |k: u32| self.crossings[k as usize].owners;
        let point = |k: u32| self.crossings[k as usize].point;
        let mut begin = 0;
        while begin < order.len() {
            let near = |other: u32| (point(other) - point(order[begin])).length() <= 1e-9 * scale;
            let end = begin + order[begin..].iter().take_while(|&&other| near(other)).count();
            let before = begin.checked_sub(1).map(|k| order[k]);
            let cluster = &mut order[begin..end];
            if cluster.len() > 1 {
                let first = |&k: &u32| cluster.iter().all(|&other| owners(other)[1] != owners(k)[0]);
                let start = match before {
                    Some(k) => owners(k)[1],
                    // The cell that begins there ends nothing in the cluster, or the cluster leads back to it.
                    None => owners(cluster.iter().copied().find(first).unwrap_or(cluster[0]))[0],
                };
                let path = trail(cluster, start, owners);
                cluster.copy_from_slice(&path);
            }
            begin = end;
        }
    }

    /// Lists what bounds each cell.
    fn list_bounds(&self) -> Bounds {
        let owners = |piece: &Piece| self.diagram.owners(piece.edge);
        let mut starts = vec![0_u32; self.diagram.len() + 1];
        let sites = self.pieces.iter().flat_map(owners).chain(self.walls.iter().map(|wall| wall.site));
        for site in sites {
            starts[site as usize + 1] += 1;
        }
        for k in 1..starts.len() {
            starts[k] += starts[k - 1];
        }
        let mut ends = starts.clone();
        let mut parts = vec![Part::Wall(0); starts[self.diagram.len()] as usize];
        let mut put = |site: u32, part: Part| {
            parts[ends[site as usize] as usize] = part;
            ends[site as usize] += 1;
        };
        for (number, piece) in (0..).zip(&self.pieces) {
            let [left, right] = owners(piece);
            put(left, Part::Piece(number, false));
            put(right, Part::Piece(number, true));
        }
        for (number, wall) in (0..).zip(&self.walls) {
            put(wall.site, Part::Wall(number));
        }
        Bounds { starts, parts }
    }

    fn parts(&self, site: usize) -> &[Part] {
        let Bounds { starts, parts } = self.bounds.get_or_init(|| self.list_bounds());
        &parts[starts[site] as usize..starts[site + 1] as usize]
    }

    /// Areas: polygons of the corners, and what lies between them and the curves.
    fn measure(&mut self) {
        for piece in &self.pieces {
            let [left, right] = self.diagram.owners(piece.edge).map(|site| site as usize);
            let [from, to] = piece.ends.map(|end| self.point(end));
            let round = self.diagram.curve(piece.edge).area_beyond_chord(from, to);
            let triangle = |site: usize| {
                let centre = self.diagram.position(site);
                0.5 * (from - centre).perp_dot(to - centre)
            };
            self.areas[left] += triangle(left) + round;
            self.areas[right] -= triangle(right) + round;
        }
        for wall in &self.walls {
            let centre = self.diagram.position(wall.site as usize);
            let mut area = 0.0;
            self.along_wall(wall, |from, to| area += 0.5 * (from - centre).perp_dot(to - centre));
            self.areas[wall.site as usize] += area;
        }
    }

    fn point(&self, end: End) -> DVec2 {
        match end {
            End::Vertex(vertex) => self.diagram.vertices()[vertex as usize].position,
            End::Crossing(crossing) => self.crossings[crossing as usize].point,
        }
    }

    /// Visits the straight sides of a stretch of wall.
    fn along_wall(&self, wall: &Wall, mut visit: impl FnMut(DVec2, DVec2)) {
        let sides = self.domain.sides();
        let corner = |side: usize| sides[side % sides.len()].from;
        let Some([first, last]) = wall.between.map(|ends| ends.map(|end| &self.crossings[end as usize]))
        else {
            (0..sides.len()).for_each(|side| visit(corner(side), corner(side + 1)));
            return;
        };
        let mut from = first.point;
        for passed in 1..=wall.corners as usize {
            let to = corner(first.side + passed);
            visit(from, to);
            from = to;
        }
        visit(from, last.point);
    }

    /// Bytes of memory that areas and pieces of edges hold.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.areas[..]) + size_of_val(&self.pieces[..])
    }

    /// The domain.
    pub fn domain(&self) -> &Domain {
        self.domain
    }

    /// Areas of all cells, 0 for hidden sites and for cells outside.
    pub fn areas(&self) -> &[f64] {
        &self.areas
    }

    /// The boundary of a cell as closed loops, each counter-clockwise. A cell cut by the domain may have several,
    /// one without a part in the domain has none.
    pub fn boundary(&self, site: usize) -> Vec<Vec<Side>> {
        let mut parts = self.parts(site).to_vec();
        let mut loops = Vec::new();
        while let Some(part) = parts.pop() {
            let mut sides = Vec::new();
            let begin = self.ends(part).map_or(NOWHERE, |[begin, _]| begin);
            let mut part = part;
            loop {
                self.draw(part, &mut sides);
                let Some([_, end]) = self.ends(part) else { break };
                let follows = |other: &Part| self.ends(*other).is_some_and(|[begin, _]| begin == end);
                let Some(next) = parts.iter().position(follows).filter(|_| end != begin) else { break };
                part = parts.swap_remove(next);
            }
            loops.push(sides);
        }
        loops
    }

    /// Sites whose cells adjoin that of `site` within the domain, in ascending order.
    pub fn neighbours(&self, site: usize) -> Vec<usize> {
        let mut neighbours: Vec<usize> = self
            .parts(site)
            .iter()
            .filter_map(|part| match *part {
                Part::Piece(piece, right) => Some(self.beyond(piece, right)),
                Part::Wall(_) => None,
            })
            .collect();
        neighbours.sort_unstable();
        neighbours.dedup();
        neighbours
    }

    /// Whether the cell reaches the boundary of the domain.
    pub fn at_boundary(&self, site: usize) -> bool {
        self.parts(site).iter().any(|part| matches!(part, Part::Wall(_)))
    }

    /// The site beyond a piece.
    fn beyond(&self, piece: u32, right: bool) -> usize {
        let owners = self.diagram.owners(self.pieces[piece as usize].edge);
        owners[usize::from(!right)] as usize
    }

    /// Begin and end of a part, with the cell at its left; none for the whole boundary of the domain.
    fn ends(&self, part: Part) -> Option<[End; 2]> {
        match part {
            Part::Piece(piece, false) => Some(self.pieces[piece as usize].ends),
            Part::Piece(piece, true) => {
                let [from, to] = self.pieces[piece as usize].ends;
                Some([to, from])
            }
            Part::Wall(wall) => self.walls[wall as usize].between.map(|ends| ends.map(End::Crossing)),
        }
    }

    fn draw(&self, part: Part, sides: &mut Vec<Side>) {
        match part {
            Part::Piece(piece, right) => {
                let [from, to] =
                    self.ends(part).map_or([DVec2::NAN; 2], |ends| ends.map(|end| self.point(end)));
                let curve = self.diagram.curve(self.pieces[piece as usize].edge);
                sides.push(Side {
                    neighbour: Some(self.beyond(piece, right)),
                    from,
                    to,
                    curve: Some((curve, right)),
                });
            }
            Part::Wall(wall) => self.along_wall(&self.walls[wall as usize], |from, to| {
                if from != to {
                    sides.push(Side { neighbour: None, from, to, curve: None });
                }
            }),
        }
    }
}
