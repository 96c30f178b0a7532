//! Regular packings in a periodic cell: strength, elastic moduli and waves with closed forms.

mod moduli;
mod strength;
mod waves;

pub(super) use moduli::run as moduli;
pub(super) use strength::run as strength;
pub(super) use waves::run as waves;

use granular_core::glam::{DVec2, DVec3};
use granular_core::{D2, D3, Dim, Linear, Spin};
use granular_dem::{
    ContactModel, Dem, Elasticity, Grain, Material, Materials, Matrix, Options, PeriodicCell, Setup,
    SetupError,
};
use granular_driver::failure::Failure;

const DENSITY: f64 = 1000.0;
/// Normal stiffness \[N/m\]; that of Hertz contacts is about the same at [`OVERLAP`].
const STIFFNESS: f64 = 1e6;
/// Overlap over the diameter where nothing else is said.
const OVERLAP: f64 = 1e-4;

pub(super) fn refused(error: SetupError) -> Failure {
    Failure::Io(error.to_string())
}

pub(super) fn name(contact: ContactModel) -> &'static str {
    match contact {
        ContactModel::Linear => "linear",
        ContactModel::Hertz => "Hertz",
    }
}

/// Equal grains of diameter 1 m that touch.
#[derive(Clone, Copy, Debug)]
pub(super) struct Touching {
    pub(super) contact: ContactModel,
    pub(super) friction: f64,
    /// Tangential over normal stiffness of linear contacts.
    pub(super) ratio: f64,
    pub(super) poisson_ratio: f64,
    pub(super) restitution: f64,
    /// Overlap over the diameter.
    pub(super) overlap: f64,
    /// Angular velocity about x, y and z \[rad/s\].
    pub(super) spin: [f64; 3],
}

impl Default for Touching {
    fn default() -> Self {
        Self {
            contact: ContactModel::Linear,
            friction: 0.5,
            ratio: 1.0,
            poisson_ratio: 0.25,
            restitution: 0.5,
            overlap: OVERLAP,
            spin: [0.0; 3],
        }
    }
}

impl Touching {
    /// Young's modulus \[Pa\] with which a contact of the usual overlap has about the stiffness of a linear one.
    fn elasticity(&self) -> Elasticity {
        Elasticity { young_modulus: STIFFNESS / OVERLAP.sqrt(), poisson_ratio: self.poisson_ratio }
    }

    pub(super) fn material(&self) -> Material {
        Material {
            density: DENSITY,
            normal_stiffness: STIFFNESS,
            elasticity: Some(self.elasticity()),
            stiffness_ratio: self.ratio,
            restitution: self.restitution,
            friction: self.friction,
            ..Material::default()
        }
    }

    /// Distance of touching centres \[m\].
    fn spacing(&self) -> f64 {
        1.0 - self.overlap
    }

    /// Force of a contact \[N\] and its stiffnesses along and across the normal \[N/m\], from the closed forms of
    /// the laws: Hertz contacts of equal spheres have `E* = E / (2 (1 - nu^2))` and `R* = d / 4`, and stiffnesses
    /// `2 E* a` and `8 G* a` with `a^2 = R* delta`.
    fn contact(&self) -> (f64, f64, f64) {
        let slides = self.friction == 0.0;
        let (force, normal, ratio) = match self.contact {
            ContactModel::Linear => (STIFFNESS * self.overlap, STIFFNESS, self.ratio),
            ContactModel::Hertz => {
                let Elasticity { young_modulus, poisson_ratio: nu } = self.elasticity();
                let stiffness = young_modulus / (1.0 - nu * nu) * (0.25 * self.overlap).sqrt();
                (stiffness * self.overlap / 1.5, stiffness, 2.0 * (1.0 - nu) / (2.0 - nu))
            }
        };
        (force, normal, if slides { 0.0 } else { ratio * normal })
    }

    /// Such grains at `places` in a cell with these edges.
    pub(super) fn in_cell<D: Dim>(
        &self,
        places: impl Iterator<Item = D::Vec>,
        edges: Matrix<D>,
        periodic: &[bool],
    ) -> Result<Dem<D>, Failure> {
        self.moving_in_cell(places.map(|place| (place, D::Vec::ZERO)), edges, periodic)
    }

    /// The same with velocities.
    fn moving_in_cell<D: Dim>(
        &self,
        moving: impl Iterator<Item = (D::Vec, D::Vec)>,
        edges: Matrix<D>,
        periodic: &[bool],
    ) -> Result<Dem<D>, Failure> {
        let mut materials = Materials::new();
        let glass = materials.add(self.material()).map_err(refused)?;
        let spin = D::Spin::of_components(self.spin);
        let grain = |(place, velocity)| Grain::at(place, 0.5, glass).moving(velocity).turning(spin);
        let options = Options { contact: self.contact, ..Options::default() };
        let gravity = D::Vec::ZERO;
        let setup = Setup { materials, grains: moving.map(grain).collect(), walls: vec![], gravity, options };
        let mut dem = Dem::new(setup).map_err(refused)?;
        dem.set_cell(PeriodicCell::with_edges(D::Vec::ZERO, edges, periodic).map_err(refused)?)
            .map_err(refused)?;
        Ok(dem)
    }

    /// A hexagonal lattice with rows along x: two rows of `columns` in each of `layers`.
    pub(super) fn hexagonal(&self, columns: usize, layers: usize) -> Result<Dem<D2>, Failure> {
        let d = self.spacing();
        let high = 3.0_f64.sqrt() * d;
        let place = move |k: usize| {
            let (row, column) = (k / columns, k % columns);
            let along = column as f64 + 0.25 + 0.5 * (row % 2) as f64;
            DVec2::new(along * d, (row as f64 * 0.5 + 0.25) * high)
        };
        let edges = box_of(&[columns as f64 * d, layers as f64 * high]);
        self.in_cell((0..2 * columns * layers).map(place), edges, &[true; 2])
    }

    pub(super) fn simple_cubic(&self, side: usize) -> Result<Dem<D3>, Failure> {
        let d = self.spacing();
        let place = move |k: usize| {
            let cube = [k % side, k / side % side, k / side / side];
            DVec3::from(cube.map(|n| (n as f64 + 0.5) * d))
        };
        self.in_cell((0..side.pow(3)).map(place), box_of(&[side as f64 * d; 3]), &[true; 3])
    }

    pub(super) fn face_centred(&self, side: usize) -> Result<Dem<D3>, Failure> {
        let a = 2.0_f64.sqrt() * self.spacing();
        let corners = [[0.0, 0.0, 0.0], [0.5, 0.5, 0.0], [0.5, 0.0, 0.5], [0.0, 0.5, 0.5]];
        let place = move |k: usize| {
            let (cube, corner) = (k / 4, DVec3::from(corners[k % 4]));
            let cube = [cube % side, cube / side % side, cube / side / side];
            (DVec3::from(cube.map(|n| n as f64 + 0.25)) + corner) * a
        };
        self.in_cell((0..4 * side.pow(3)).map(place), box_of(&[side as f64 * a; 3]), &[true; 3])
    }
}

fn box_of<D: Dim>(edges: &[f64]) -> Matrix<D> {
    Matrix::from_fn(|row, column| if row == column { edges[row] } else { 0.0 })
}
