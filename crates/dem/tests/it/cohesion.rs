//! Laws of the caller's own that act before surfaces overlap: a capillary bridge and an attraction.

use granular_core::glam::{DVec2, DVec3};
use granular_core::quantity::Load as Given;
use granular_core::{D2, D3, Dim, Linear, Section, Solver, StepError, Vector};
use granular_dem::{
    CellControl, ContactLaw, ContactLoad, Control, Dem, Grain, Kinematics, LawLimits, Material, MaterialId,
    Materials, Options, PeriodicCell, Setup, Tally, Wall,
};

const GLASS: MaterialId = MaterialId::of_index(0);
const RADIUS: f64 = 1e-3;

/// A linear contact with a liquid bridge: it forms when surfaces touch, pulls with `force (1 - gap / rupture)`, as a bridge of
/// a given volume does in the first approximation, and breaks at the distance `rupture`. Its work from contact to rupture is
/// `force rupture / 2`.
#[derive(Clone, Copy, Debug)]
struct Bridge {
    stiffness: f64,
    force: f64,
    rupture: f64,
}

impl Bridge {
    fn pull(&self, gap: f64) -> f64 {
        self.force * (1.0 - gap.max(0.0) / self.rupture)
    }

    /// Energy of a bridge, nothing where it breaks \[J\].
    fn energy(&self, gap: f64) -> f64 {
        let share = 1.0 - gap.max(0.0) / self.rupture;
        -0.5 * self.force * self.rupture * share * share + self.force * gap.min(0.0)
    }
}

impl<D: Dim> ContactLaw<D> for Bridge {
    /// One where there is a bridge.
    type Memory = f64;
    const TANGENTIAL: bool = false;
    const REACHES: bool = true;
    const NAME: &'static str = "linear with a liquid bridge";

    fn reach(&self) -> f64 {
        self.rupture
    }

    fn acts(&self, gap: f64, bridge: &f64) -> bool {
        *bridge == 1.0 && gap < self.rupture
    }

    fn limits(&self, _: f64) -> Option<LawLimits> {
        Some(LawLimits { normal_stiffness: self.stiffness, ..LawLimits::default() })
    }

    fn load<const LEDGER: bool>(
        &self,
        m: &Kinematics<D>,
        bridge: &mut f64,
        tally: &mut Tally<LEDGER>,
    ) -> ContactLoad<D> {
        let forms = *bridge == 0.0 && m.presence > 0.0;
        if forms {
            *bridge = 1.0;
            // What the bridge takes before it breaks is gone.
            tally.normal_damping(|| 0.5 * self.force * self.rupture);
        }
        if *bridge == 0.0 || m.gap >= self.rupture {
            *bridge = 0.0;
            return ContactLoad::along_normal(0.0);
        }
        // In the step in which it forms it pulls for the share of the step.
        let share = if forms { m.presence } else { 1.0 };
        ContactLoad::along_normal(self.stiffness * m.overlap - share * self.pull(m.gap))
    }

    fn reversed(bridge: f64) -> f64 {
        bridge
    }

    fn at_rest(&self, m: &Kinematics<D>, bridge: f64) -> (ContactLoad<D>, f64) {
        let overlap = (-m.gap).max(0.0);
        let elastic = 0.5 * self.stiffness * overlap * overlap;
        if bridge == 0.0 {
            return (ContactLoad::along_normal(self.stiffness * overlap), elastic);
        }
        (ContactLoad::along_normal(self.stiffness * overlap - self.pull(m.gap)), elastic + self.energy(m.gap))
    }
}

/// A linear contact with an attraction `force (1 - gap / range)^2` of all surfaces nearer than its range: no memory, and no
/// energy is lost.
#[derive(Clone, Copy, Debug)]
struct Attraction {
    stiffness: f64,
    force: f64,
    range: f64,
}

impl<D: Dim> ContactLaw<D> for Attraction {
    type Memory = ();
    const TANGENTIAL: bool = false;
    const REACHES: bool = true;
    const NAME: &'static str = "linear with attraction";

    fn reach(&self) -> f64 {
        self.range
    }

    fn limits(&self, _: f64) -> Option<LawLimits> {
        Some(LawLimits { normal_stiffness: self.stiffness, ..LawLimits::default() })
    }

    fn load<const LEDGER: bool>(
        &self,
        m: &Kinematics<D>,
        (): &mut (),
        _: &mut Tally<LEDGER>,
    ) -> ContactLoad<D> {
        let share = (1.0 - m.gap.max(0.0) / self.range).max(0.0);
        ContactLoad::along_normal(self.stiffness * m.overlap - self.force * share * share)
    }

    fn reversed((): ()) {}

    fn at_rest(&self, m: &Kinematics<D>, (): ()) -> (ContactLoad<D>, f64) {
        let (overlap, share) = ((-m.gap).max(0.0), (1.0 - m.gap.max(0.0) / self.range).max(0.0));
        let energy = -self.force * self.range * share.powi(3) / 3.0 - self.force * overlap;
        let force = self.stiffness * overlap - self.force * share * share;
        (ContactLoad::along_normal(force), 0.5 * self.stiffness * overlap * overlap + energy)
    }
}

const BRIDGE: Bridge = Bridge { stiffness: 1e4, force: 0.02, rupture: 1e-4 };
const ATTRACTION: Attraction = Attraction { stiffness: 1e4, force: 0.02, range: 1e-4 };

fn of<D: Dim, L: ContactLaw<D>>(law: L, grains: Vec<Grain<D>>, floor: bool) -> Dem<D> {
    skinned(law, grains, floor, Options::default().skin)
}

fn skinned<D: Dim, L: ContactLaw<D>>(law: L, grains: Vec<Grain<D>>, floor: bool, skin: f64) -> Dem<D> {
    let mut materials = Materials::new();
    let glass = materials.add(Material::default()).unwrap();
    let plane = Wall::plane("floor", D::Vec::ZERO, D::Vec::along(D::UP, 1.0), glass).unwrap();
    let walls = if floor { vec![plane] } else { vec![] };
    let options = Options { ledger: true, skin, ..Options::default() };
    Dem::with_law(Setup { materials, grains, walls, gravity: D::Vec::ZERO, options }, law).unwrap()
}

/// Two grains on the x axis whose surfaces are `gap` apart, each with this speed towards the other.
fn pair<D: Dim>(gap: f64, speed: f64) -> Vec<Grain<D>> {
    let place = |x: f64| D::Vec::along(0, x) + D::Vec::along(1, 5e-3);
    vec![
        Grain::at(place(2e-3), RADIUS, GLASS).moving(D::Vec::along(0, speed)),
        Grain::at(place(4e-3 + gap), RADIUS, GLASS).moving(D::Vec::along(0, -speed)),
    ]
}

fn bytes<D: Dim>(dem: &Dem<D>) -> String {
    let mut section = Section::new("dem");
    dem.save(&mut section);
    format!("{section:?}")
}

/// Speed at which two grains part that met at `speed` over a bridge, and whether they did.
fn parting<D: Dim>(speed: f64, shorter: f64) -> f64 {
    let mut dem = of(BRIDGE, pair::<D>(2e-5, speed), false);
    let dt = dem.recommended_step() / shorter;
    dem.advance(dt, (0.02 / dt) as u64).unwrap();
    let residual = dem.energy_residual().unwrap().abs();
    assert!(residual < 1e-3 * BRIDGE.force * BRIDGE.rupture, "the ledger misses {residual}");
    dem.grain(1).velocity.component(0)
}

/// The bridge does not act before it forms; then parting costs `force rupture / 2`.
fn parting_costs_the_work_of_the_bridge<D: Dim>() {
    let mass = Material::default().density * D::ball_volume(RADIUS);
    let needed = (0.5 * BRIDGE.force * BRIDGE.rupture / mass).sqrt();
    for faster in [1.2_f64, 2.0] {
        let exact = needed * (faster * faster - 1.0).sqrt();
        let found = parting::<D>(faster * needed, 40.0);
        assert!((found - exact).abs() < 2e-3 * exact, "{faster}: {found} {exact}");
    }
    // Slower grains stay together.
    let mut bound = of(BRIDGE, pair::<D>(2e-5, 0.9 * needed), false);
    let dt = bound.recommended_step();
    bound.advance(dt, (0.1 / dt) as u64).unwrap();
    let apart = (bound.grain(1).position - bound.grain(0).position).length() - 2.0 * RADIUS;
    assert!(apart < BRIDGE.rupture, "{apart}");
}

#[test]
fn grains_part_from_a_bridge_when_they_have_its_energy() {
    parting_costs_the_work_of_the_bridge::<D2>();
    parting_costs_the_work_of_the_bridge::<D3>();
}

/// Two grains that are pulled apart part at the pull-off force, and no sooner.
#[test]
fn the_pull_off_force_is_that_of_the_bridge() {
    for (share, parts) in [(0.99, false), (1.01, true)] {
        let force = share * BRIDGE.force;
        // Where spring, bridge and pull are in balance; pulled beyond the pull-off force from where nothing overlaps.
        let overlap = ((BRIDGE.force - force) / BRIDGE.stiffness).max(1e-9);
        let mut dem = of(BRIDGE, pair::<D3>(-overlap, 0.0), false);
        for (id, sign) in [(0, -1.0), (1, 1.0)] {
            dem.set_load(id, Given { force: DVec3::X * force * sign, torque: DVec3::ZERO }).unwrap();
        }
        let dt = dem.recommended_step();
        dem.advance(dt, 1).unwrap();
        let mut pull = 0.0;
        dem.visit_contacts(&mut |contact| pull = -contact.normal_force);
        assert!((pull / force - 1.0).abs() < 0.02, "{pull} {force}");
        let time = 8.0 * (dem.mass_of(0) * BRIDGE.rupture / (force - BRIDGE.force).abs()).sqrt();
        dem.advance(dt, (time / dt) as u64).unwrap();
        let gap = dem.grain(1).position.x - dem.grain(0).position.x - 2.0 * RADIUS;
        assert_eq!(gap > BRIDGE.rupture, parts, "{share}: {gap}");
    }
}

/// Between grains, at a wall, and across the face of a cell: at rest and apart, the first acceleration is that of the law, and
/// energy is kept to the end.
fn surfaces_attract_before_they_overlap<D: Dim>() {
    let gap = 0.4 * ATTRACTION.range;
    let pull = ATTRACTION.force * 0.6 * 0.6;
    let on_wall = vec![Grain::at(D::Vec::along(D::UP, RADIUS + gap), RADIUS, GLASS)];
    let edge = 10e-3;
    let at_faces = [0.5e-3, 0.5e-3 + edge - 2.0 * RADIUS - gap]
        .map(|x| Grain::at(D::Vec::splat(0.5 * edge) + D::Vec::along(0, x - 0.5 * edge), RADIUS, GLASS))
        .to_vec();
    let mut in_cell = of(ATTRACTION, at_faces, false);
    in_cell
        .set_cell(PeriodicCell::new(D::Vec::ZERO, D::Vec::splat(edge), &[true; 3][..D::N]).unwrap())
        .unwrap();
    let alone = of(ATTRACTION, pair::<D>(gap, 0.0), false);
    let at_floor = of(ATTRACTION, on_wall, true);
    for (name, mut dem) in [("pair", alone), ("wall", at_floor), ("cell", in_cell)] {
        let (mut contacts, mut apart) = (0, 0.0);
        dem.visit_contacts(&mut |contact| (contacts, apart) = (contacts + 1, -contact.overlap));
        assert_eq!(contacts, 1, "{name}");
        let expected = ATTRACTION.force * (1.0 - apart / ATTRACTION.range).powi(2);
        assert!((expected - pull).abs() < 1e-9 * pull, "{name}: {apart} {gap}");
        let dt = dem.recommended_step() / 10.0;
        dem.advance(dt, 1).unwrap();
        let found = dem.grain(0).velocity.length() * dem.mass_of(0) / dt;
        assert!((found - expected).abs() < 1e-6 * expected, "{name}: {found} {expected}");
        dem.advance(dt, 20_000).unwrap();
        let scale = ATTRACTION.force * ATTRACTION.range / 3.0;
        assert!(
            dem.energy_residual().unwrap().abs() < 2e-3 * scale,
            "{name}: {}",
            dem.energy_residual().unwrap() / scale
        );
        assert!(dem.deepest_overlap() >= 0.0);
    }
}

#[test]
fn attraction_acts_before_surfaces_overlap_between_grains_at_walls_and_across_faces() {
    surfaces_attract_before_they_overlap::<D2>();
    surfaces_attract_before_they_overlap::<D3>();
}

/// A heap of disks whose neighbours are within reach of each other, above a floor.
fn heap(skin: f64) -> Dem<D2> {
    let at = |k: usize| DVec2::new((k % 20) as f64 + 0.5, (k / 20) as f64 + 0.5) * 2.03e-3;
    let speed = |k: usize| DVec2::new((k as f64).sin(), (2.0 * k as f64).cos()) * 0.02;
    let grains = (0..300).map(|k| Grain::at(at(k), RADIUS, GLASS).moving(speed(k))).collect();
    skinned(BRIDGE, grains, true, skin)
}

#[test]
fn reach_changes_no_bits_with_the_lists_threads_or_a_restart() {
    let dt = heap(0.25).recommended_step();
    let run = |skin: f64, threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let mut dem = heap(skin);
        pool.install(|| dem.advance(dt, 3000)).unwrap();
        bytes(&dem)
    };
    let whole = run(0.25, 1);
    assert!(run(0.03, 1) == whole && run(0.5, 3) == whole);
    let mut first = heap(0.25);
    first.advance(dt, 1300).unwrap();
    let mut section = Section::new("dem");
    first.save(&mut section);
    let mut second = heap(0.25);
    second.restore(&section).unwrap();
    (0..1700).for_each(|_| second.advance(dt, 1).unwrap());
    assert!(bytes(&second) == whole);
    let mut bridges = 0;
    second.visit_contacts(&mut |contact| bridges += i32::from(contact.overlap < 0.0));
    assert!(bridges > 20, "{bridges} bridges across gaps");
}

/// A law that tells the ledger what is not a number.
#[derive(Clone, Copy, Debug)]
struct Broken;

impl<D: Dim> ContactLaw<D> for Broken {
    type Memory = ();
    const TANGENTIAL: bool = false;
    const NAME: &'static str = "broken";

    fn load<const LEDGER: bool>(
        &self,
        _: &Kinematics<D>,
        (): &mut (),
        tally: &mut Tally<LEDGER>,
    ) -> ContactLoad<D> {
        tally.normal_damping(|| f64::NAN);
        ContactLoad::along_normal(0.0)
    }

    fn reversed((): ()) {}

    fn at_rest(&self, _: &Kinematics<D>, (): ()) -> (ContactLoad<D>, f64) {
        (ContactLoad::along_normal(0.0), 0.0)
    }
}

#[test]
fn losses_are_watched_with_and_without_a_cell() {
    for in_cell in [false, true] {
        let mut dem = of::<D2, _>(Broken, pair(-1e-5, 0.0), false);
        if in_cell {
            dem.set_cell(PeriodicCell::new(DVec2::ZERO, DVec2::splat(10e-3), &[true, true]).unwrap())
                .unwrap();
            dem.control_cell(CellControl::default().with(0, 1, Control::Rate(1.0))).unwrap();
        }
        let error = dem.advance(1e-8, 1).unwrap_err();
        assert!(
            matches!(error, StepError::NotFinite { quantity: "losses of energy", .. }),
            "{in_cell}: {error}"
        );
    }
}

#[test]
fn the_limits_are_those_of_the_law() {
    let dem = of(BRIDGE, pair::<D2>(0.0, 0.0), false);
    let softer = of(Bridge { stiffness: 0.25 * BRIDGE.stiffness, ..BRIDGE }, pair::<D2>(0.0, 0.0), false);
    assert!((softer.stable_step() / dem.stable_step() - 2.0).abs() < 1e-12);
    let effective = 0.5 * dem.mass_of(0);
    assert!((dem.stable_step() / (2.0 * (effective / BRIDGE.stiffness).sqrt()) - 1.0).abs() < 1e-12);
}

/// A law with friction that reads no predicted motion, and says so.
#[derive(Clone, Copy, Debug)]
struct Blind;

impl<D: Dim> ContactLaw<D> for Blind {
    type Memory = ();
    const TANGENTIAL: bool = true;
    const NAME: &'static str = "blind";

    fn predicts(&self) -> bool {
        false
    }

    fn load<const LEDGER: bool>(
        &self,
        m: &Kinematics<D>,
        (): &mut (),
        _: &mut Tally<LEDGER>,
    ) -> ContactLoad<D> {
        assert!(m.slip == D::Spin::ZERO && m.roll == D::Spin::ZERO, "nothing is predicted that no law reads");
        assert!(m.start_slip != D::Spin::ZERO, "the surfaces do slip");
        ContactLoad::along_normal(0.0)
    }

    fn reversed((): ()) {}

    fn at_rest(&self, _: &Kinematics<D>, (): ()) -> (ContactLoad<D>, f64) {
        (ContactLoad::along_normal(0.0), 0.0)
    }
}

#[test]
fn motion_is_predicted_for_laws_that_read_it_only_with_and_without_a_cell() {
    for in_cell in [false, true] {
        let grains = pair::<D2>(-1e-5, 0.0).into_iter().map(|grain| grain.turning(300.0)).collect();
        let mut dem = of(Blind, grains, false);
        if in_cell {
            dem.set_cell(PeriodicCell::new(DVec2::ZERO, DVec2::splat(10e-3), &[true, true]).unwrap())
                .unwrap();
        }
        dem.advance(1e-8, 3).unwrap();
    }
}
