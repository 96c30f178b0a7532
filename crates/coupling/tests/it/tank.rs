//! A tank of fluid with free grains.

use granular_core::{Dim, ImmersedGrains, Linear, NodeKey, Provides, Simulation, Vector};
use granular_coupling::{ResolvedGrains, ResolvedOptions};
use granular_dem::{Dem, Grain, Material, MaterialId, Materials, Options, Wall};
use granular_lbm::{Flow, Lattice, Lbm, Setup};

/// Steps of grains in one of the fluid.
pub(crate) const SUBSTEPS: f64 = 4.0;

/// What is in the tank. Units are cells, steps and the mass of the fluid of a cell.
pub(crate) struct Tank<L: Lattice<Q>, const Q: usize> {
    pub(crate) simulation: Simulation,
    pub(crate) fluid: NodeKey<Lbm<L, Q>>,
    pub(crate) grains: NodeKey<Dem<L::Dim>>,
}

/// A ball in cells and steps: place, velocity and radius.
pub(crate) type BallIn<D> = (<D as Dim>::Vec, <D as Dim>::Vec, f64);

/// A fluid with cells, steps and a density of one.
pub(crate) fn unit_fluid<D: Dim>(cells: [usize; 3], tau: f64) -> Setup<D> {
    let mut setup = Setup::new(cells, 1.0, (tau - 0.5) / 3.0, tau);
    setup.density = 1.0;
    setup.time_step = 1.0;
    setup
}

/// Stiffness that is stable at the steps of grains, for balls of a density and a radius.
pub(crate) fn stiffness<D: Dim>(density: f64, radius: f64) -> f64 {
    // Twenty steps in a contact of two.
    let mass = density * D::ball_volume(radius);
    0.5 * mass * (std::f64::consts::PI * SUBSTEPS / 20.0).powi(2)
}

pub(crate) struct Balls<D: Dim> {
    pub(crate) balls: Vec<BallIn<D>>,
    pub(crate) density: f64,
    pub(crate) gravity: D::Vec,
    pub(crate) friction: f64,
    /// Height of a floor, if there is one.
    pub(crate) floor: Option<f64>,
}

impl<D: Dim> Balls<D> {
    pub(crate) fn of(density: f64, balls: Vec<BallIn<D>>) -> Self {
        Self { balls, density, gravity: D::Vec::ZERO, friction: 0.0, floor: None }
    }

    pub(crate) fn solver(&self) -> Dem<D> {
        let smallest = self.balls.iter().map(|ball| ball.2).fold(f64::INFINITY, f64::min);
        let mut materials = Materials::new();
        let (density, friction) = (self.density, self.friction);
        let normal_stiffness = stiffness::<D>(density, if self.balls.is_empty() { 2.0 } else { smallest });
        let stone =
            materials.add(Material { density, friction, normal_stiffness, ..Material::default() }).unwrap();
        let grain = |&(place, velocity, radius): &BallIn<D>| Grain::at(place, radius, stone).moving(velocity);
        let grains = self.balls.iter().map(grain).collect();
        let walls = self.walls(stone);
        let options = Options { ledger: true, ..Options::default() };
        Dem::new(granular_dem::Setup { materials, grains, walls, gravity: self.gravity, options }).unwrap()
    }

    fn walls(&self, material: MaterialId) -> Vec<Wall<D>> {
        let up = D::Vec::along(D::UP, 1.0);
        self.floor.iter().map(|height| Wall::plane("floor", up * *height, up, material).unwrap()).collect()
    }
}

impl<L: Lattice<Q>, const Q: usize> Tank<L, Q> {
    pub(crate) fn new(
        setup: Setup<L::Dim>,
        flow: impl Fn(<L::Dim as Dim>::Vec) -> <L::Dim as Dim>::Vec,
        balls: &Balls<L::Dim>,
        options: ResolvedOptions<L::Dim>,
    ) -> Self {
        Self::of(setup, flow, balls.solver(), options)
    }

    pub(crate) fn of(
        setup: Setup<L::Dim>,
        flow: impl Fn(<L::Dim as Dim>::Vec) -> <L::Dim as Dim>::Vec,
        grains: Dem<L::Dim>,
        options: ResolvedOptions<L::Dim>,
    ) -> Self {
        let mut fluid = Lbm::<L, Q>::new(setup).unwrap();
        fluid.set_flow(|point| Flow { pressure: 0.0, velocity: flow(point) });
        let mut simulation = Simulation::named("fluid", Box::new(fluid));
        let fluid = simulation.find::<Lbm<L, Q>>("fluid").unwrap();
        let grains = simulation.add("grains", grains).unwrap();
        simulation.couple(fluid, grains, ResolvedGrains::new(options)).unwrap();
        simulation.choose_step(grains, 1.0 / SUBSTEPS);
        simulation.begin_segment(1.0).unwrap();
        Self { simulation, fluid, grains }
    }

    pub(crate) fn fluid(&self) -> &Lbm<L, Q> {
        self.simulation.get(self.fluid)
    }

    pub(crate) fn grains(&self) -> &Dem<L::Dim> {
        self.simulation.get(self.grains)
    }

    pub(crate) fn velocity(&self, id: u32) -> <L::Dim as Dim>::Vec {
        self.grains().grain(id).velocity
    }

    pub(crate) fn advance(&mut self, steps: u64) {
        self.simulation.advance(steps).unwrap();
    }

    /// Momentum of the fluid, that within grains included.
    pub(crate) fn momentum_of_fluid(&self) -> <L::Dim as Dim>::Vec {
        let field = self.fluid().flow_field();
        let mut sum = <L::Dim as Dim>::Vec::ZERO;
        for (velocity, pressure) in field.velocities.iter().zip(&field.pressures) {
            sum += *velocity * (1.0 + 3.0 * pressure);
        }
        sum
    }

    /// Momentum of grains.
    pub(crate) fn momentum_of_grains(&self) -> <L::Dim as Dim>::Vec {
        let dem = self.grains();
        let mut sum = <L::Dim as Dim>::Vec::ZERO;
        for ((_, grain), mass) in dem.grains().zip(dem.masses()) {
            sum += grain.velocity * *mass;
        }
        sum
    }

    /// Velocities and volumes of grains as the fluid met them last.
    pub(crate) fn met(&self) -> Vec<(<L::Dim as Dim>::Vec, f64)> {
        let list = Provides::<ImmersedGrains<L::Dim>>::view(self.fluid());
        list.iter().map(|grain| (grain.motion.velocity, L::Dim::ball_volume(grain.radius))).collect()
    }
}
