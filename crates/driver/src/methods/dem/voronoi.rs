//! Voronoi cells of the grains of a solver: packing density and stress of each grain, of the bulk and on a grid
//! \[Kumar2014, section 3.5.7\].
//!
//! In the plane cells are those of the additively weighted diagram, in space those of the power diagram. They end at planes that rest
//! and at the box around all grains; in a cell that is periodic along both axes they end nowhere. Cells much larger
//! than the mean are free surface and no part of the bulk. Nothing is stored and nothing is worked out unless a sink wants it.

mod grid;

pub(super) use grid::{show_on_grid, shown_on_grid};

use crate::scene::Scene;
use granular_core::glam::{DVec2, DVec3};
use granular_core::{
    D2, D3, Dim, FieldRef, FieldSink, GrainMotion, Provides, Shown, ShownAs, Solver, SymmetricTensor,
};
use granular_dem::{Dem, Shape};
use granular_tessellate::{Bulk, Diagram, Domain, TessellationError, bulk_of, periodic_areas, power_cells};
use std::any::Any;

const BULK_DENSITY: &str = "bulk_density";
const BULK_GRAINS: &str = "bulk_grains";
const LOCAL_DENSITY: &str = "local_density";
const CELL_VOLUME: &str = "cell_volume";
const CELL_STRESS: &str = "cell_stress";
const IN_BULK: &str = "in_bulk";

/// Name of a component of stress, and how it is taken.
type Component = (&'static str, fn(&SymmetricTensor) -> f64);

/// Components of the stress of the bulk.
const STRESSES: [Component; 6] = [
    ("bulk_stress_xx", |s| s.xx),
    ("bulk_stress_yy", |s| s.yy),
    ("bulk_stress_xy", |s| s.xy),
    ("bulk_stress_zz", |s| s.zz),
    ("bulk_stress_yz", |s| s.yz),
    ("bulk_stress_xz", |s| s.xz),
];

/// Names, units and meanings; the unit of volumes is that of space.
const NUMBERS: &[(&str, &str, &str)] = &[
    (BULK_DENSITY, "1", "share of the grains in their Voronoi cells, without the free surface"),
    (BULK_GRAINS, "1", "grains whose Voronoi cell is not at the free surface"),
];
const FIELDS: &[(&str, &str, &str)] = &[
    (LOCAL_DENSITY, "1", "share of the grain in its Voronoi cell"),
    (CELL_STRESS, "Pa", "stress of contacts over the Voronoi cell, positive in compression"),
    (IN_BULK, "1", "1 where the Voronoi cell is part of the bulk, 0 at the free surface"),
];
const STRESS: &str = "stress of contacts over the Voronoi cells of the bulk, positive in compression";
const VOLUME: &str = "Voronoi cell of the grain";

#[cfg(test)]
thread_local! {
    /// Tessellations made on this thread.
    static MADE: std::cell::Cell<usize> = const { std::cell::Cell::new(0) };
}

/// The grains of a solver that have Voronoi cells.
#[derive(Clone, Copy)]
enum Packing<'a> {
    Plane(&'a Dem<D2>),
    Space(&'a Dem<D3>),
}

impl<'a> Packing<'a> {
    /// None without grains, and where only some axes are periodic.
    fn of(solver: &'a dyn Solver) -> Option<Self> {
        let any: &dyn Any = solver;
        if let Some(dem) = any.downcast_ref::<Dem<D2>>() {
            let fits = dem.cell().is_none_or(|cell| cell.is_closed());
            return fits.then_some(Self::Plane(dem));
        }
        let dem = any.downcast_ref::<Dem<D3>>()?;
        dem.cell().is_none().then_some(Self::Space(dem))
    }

    fn unit_of_volume(self) -> &'static str {
        match self {
            Self::Plane(_) => "m^2",
            Self::Space(_) => "m^3",
        }
    }

    /// Components of stress, in the plane three.
    fn stresses(self) -> usize {
        match self {
            Self::Plane(_) => 3,
            Self::Space(_) => 6,
        }
    }

    fn stress(self) -> Vec<SymmetricTensor> {
        match self {
            Self::Plane(dem) => dem.grain_stress(),
            Self::Space(dem) => dem.grain_stress(),
        }
    }

    /// Volumes of grains and of their cells.
    fn tessellated(self) -> Result<Tessellated, TessellationError> {
        #[cfg(test)]
        MADE.set(MADE.get() + 1);
        match self {
            // Before the first one comes in through an inlet.
            Self::Plane(dem) if dem.is_empty() => Ok(Tessellated::default()),
            Self::Space(dem) if dem.is_empty() => Ok(Tessellated::default()),
            Self::Plane(dem) => {
                let (positions, radii) = grains(dem);
                Ok(Tessellated { solids: solids::<D2>(&radii), cells: in_plane(dem, &positions, &radii)? })
            }
            Self::Space(dem) => {
                let (positions, radii) = grains(dem);
                let [low, high] = room(dem, &positions, &radii);
                let cells = power_cells(&positions, &radii, low, high)?;
                let cells = cells.into_iter().map(|cell| cell.volume).collect();
                Ok(Tessellated { solids: solids::<D3>(&radii), cells })
            }
        }
    }
}

/// Volumes of grains and of their cells.
#[derive(Default)]
struct Tessellated {
    solids: Vec<f64>,
    cells: Vec<f64>,
}

impl Tessellated {
    fn densities(&self) -> Vec<f64> {
        let density = |(solid, &cell): (&f64, &f64)| if cell > 0.0 { solid / cell } else { 0.0 };
        self.solids.iter().zip(&self.cells).map(density).collect()
    }

    /// Which cells are part of the bulk.
    fn in_bulk(&self, bulk: Option<&Bulk>) -> Vec<bool> {
        let limit = bulk.map_or(0.0, |bulk| bulk.limit);
        self.solids
            .iter()
            .zip(&self.cells)
            .map(|(solid, &cell)| cell > 0.0 && cell <= limit * solid)
            .collect()
    }
}

/// Everything that grains can show with their cells; nothing for other solvers.
pub(super) fn shown(solver: &dyn Solver) -> Vec<Shown> {
    let Some(packing) = Packing::of(solver) else { return Vec::new() };
    let entry = |kind| {
        move |&(name, unit, meaning): &(&str, &'static str, &'static str)| {
            Shown::new(name, unit, meaning, kind)
        }
    };
    let stresses = STRESSES.iter().take(packing.stresses()).map(|(name, _)| (*name, "Pa", STRESS));
    let volume = (CELL_VOLUME, packing.unit_of_volume(), VOLUME);
    let numbers = NUMBERS.iter().copied().chain(stresses);
    let mut list: Vec<Shown> = numbers.map(|number| entry(ShownAs::Number)(&number)).collect();
    list.extend([volume].iter().chain(FIELDS).map(entry(ShownAs::Field)));
    list
}

/// Whether grains could show cells and no output of the scene asks for any.
pub(super) fn is_unused(scene: &Scene, solver: &dyn Solver) -> bool {
    let shown = shown(solver);
    let is_asked = |name: &String| shown.iter().any(|shown| shown.name == *name);
    !shown.is_empty() && !scene.outputs.iter().any(|output| output.write.names().iter().any(is_asked))
}

/// Shows what a sink wants of the cells. Cells larger than `free_surface` times the mean are no part of the bulk.
pub(super) fn show(solver: &dyn Solver, free_surface: f64, sink: &mut dyn FieldSink) {
    let Some(packing) = Packing::of(solver) else { return };
    let stresses = &STRESSES[..packing.stresses()];
    let names = NUMBERS.iter().chain(FIELDS).map(|(name, ..)| *name);
    let mut names = names.chain([CELL_VOLUME]).chain(stresses.iter().map(|(name, _)| *name));
    if !names.any(|name| sink.wants(name)) {
        return;
    }
    // Grains with places and sizes that are no numbers have stopped the run before.
    let Ok(tessellated) = packing.tessellated() else { return };
    let bulk = bulk_of(&tessellated.solids, &tessellated.cells, free_surface);
    let in_bulk = tessellated.in_bulk(bulk.as_ref());
    if sink.wants(BULK_DENSITY) {
        sink.number(BULK_DENSITY, "1", bulk.as_ref().map_or(f64::NAN, |bulk| bulk.density));
    }
    if sink.wants(BULK_GRAINS) {
        sink.number(BULK_GRAINS, "1", bulk.as_ref().map_or(0.0, |bulk| bulk.cells as f64));
    }
    if sink.wants(CELL_VOLUME) {
        sink.field(CELL_VOLUME, packing.unit_of_volume(), FieldRef::Scalar(&tessellated.cells));
    }
    if sink.wants(LOCAL_DENSITY) {
        sink.field(LOCAL_DENSITY, "1", FieldRef::Scalar(&tessellated.densities()));
    }
    if sink.wants(IN_BULK) {
        let flags: Vec<u32> = in_bulk.iter().map(|&inside| u32::from(inside)).collect();
        sink.field(IN_BULK, "1", FieldRef::Index(&flags));
    }
    if sink.wants(CELL_STRESS) || stresses.iter().any(|(name, _)| sink.wants(name)) {
        show_stress(packing, &tessellated, &in_bulk, sink);
    }
}

/// The stress of a grain is over its own volume; that of a cell is over the cell.
fn show_stress(packing: Packing<'_>, tessellated: &Tessellated, in_bulk: &[bool], sink: &mut dyn FieldSink) {
    let stress = packing.stress();
    if sink.wants(CELL_STRESS) {
        let densities = tessellated.densities();
        let of_cells: Vec<SymmetricTensor> =
            stress.iter().zip(densities).map(|(&stress, density)| stress * density).collect();
        sink.field(CELL_STRESS, "Pa", FieldRef::Tensor(&of_cells));
    }
    let (mut sum, mut volume) = (SymmetricTensor::ZERO, 0.0);
    for grain in (0..stress.len()).filter(|&grain| in_bulk[grain]) {
        sum += stress[grain] * tessellated.solids[grain];
        volume += tessellated.cells[grain];
    }
    for (name, component) in &STRESSES[..packing.stresses()] {
        if sink.wants(name) {
            sink.number(name, "Pa", component(&sum) / volume);
        }
    }
}

fn grains<D: Dim>(dem: &Dem<D>) -> (Vec<D::Vec>, Vec<f64>) {
    let grains = Provides::<GrainMotion<D>>::view(dem);
    grains.iter().map(|(_, motion, radius)| (motion.position, radius)).unzip()
}

fn solids<D: Dim>(radii: &[f64]) -> Vec<f64> {
    radii.iter().map(|&radius| D::ball_volume(radius)).collect()
}

fn in_plane(dem: &Dem<D2>, positions: &[DVec2], radii: &[f64]) -> Result<Vec<f64>, TessellationError> {
    if let Some(cell) = dem.cell() {
        let [a, b, _] = cell.edges().columns;
        return periodic_areas(positions, radii, [a, b]);
    }
    let diagram = Diagram::new(positions, radii)?;
    let domain = room_in_plane(dem, positions, radii)?;
    Ok(diagram.cells(&domain).areas().to_vec())
}

/// The box around all grains, cut at planes that rest.
fn room_in_plane(dem: &Dem<D2>, positions: &[DVec2], radii: &[f64]) -> Result<Domain, TessellationError> {
    let mut low = DVec2::INFINITY;
    let mut high = DVec2::NEG_INFINITY;
    for (&position, &radius) in positions.iter().zip(radii) {
        (low, high) = (low.min(position - radius), high.max(position + radius));
    }
    let corners = vec![low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)];
    let mut cut = corners.clone();
    for (point, normal) in planes(dem) {
        cut = grid::cut_at_line(&cut, point, normal);
    }
    cut.dedup();
    // Walls that leave no room are no walls of these grains.
    Domain::polygon(&cut).or_else(|_| Domain::polygon(&corners))
}

/// Planes that rest and are not out of the way: a point, and the normal into the grains.
fn planes<D: Dim>(dem: &Dem<D>) -> impl Iterator<Item = (D::Vec, D::Vec)> + '_ {
    dem.walls().iter().filter(|wall| !wall.open && wall.motion.is_none()).filter_map(|wall| {
        match wall.shape {
            Shape::Plane { point, normal } => Some((point, normal)),
            _ => None,
        }
    })
}

/// The box around all grains, cut at planes that rest across an axis.
fn room(dem: &Dem<D3>, positions: &[DVec3], radii: &[f64]) -> [DVec3; 2] {
    let mut low = DVec3::INFINITY;
    let mut high = DVec3::NEG_INFINITY;
    for (&position, &radius) in positions.iter().zip(radii) {
        (low, high) = (low.min(position - radius), high.max(position + radius));
    }
    for (point, normal) in planes(dem) {
        for axis in 0..3 {
            if normal[axis] == 1.0 && point[axis] < high[axis] {
                low[axis] = low[axis].max(point[axis]);
            } else if normal[axis] == -1.0 && point[axis] > low[axis] {
                high[axis] = high[axis].min(point[axis]);
            }
        }
    }
    [low, high]
}

#[cfg(test)]
mod tests;
