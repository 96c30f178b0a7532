//! Invariance under the symmetries of the lattice, and what is conserved.

use granular_core::glam::DVec2;
use granular_core::{Section, Solver};
use granular_lbm::*;
use proptest::prelude::*;

const SIDE: usize = 12;

/// A map of the square onto itself: coordinates may be exchanged, and each mirrored.
#[derive(Clone, Copy, Debug)]
struct Symmetry {
    exchange: bool,
    mirror: [bool; 2],
}

impl Symmetry {
    fn vector(self, v: DVec2) -> DVec2 {
        let v = if self.exchange { DVec2::new(v.y, v.x) } else { v };
        DVec2::new(if self.mirror[0] { -v.x } else { v.x }, if self.mirror[1] { -v.y } else { v.y })
    }

    fn point(self, p: DVec2) -> DVec2 {
        let middle = DVec2::splat(0.5 * SIDE as f64);
        self.vector(p - middle) + middle
    }

    fn cell(self, [x, y]: [usize; 2]) -> [usize; 3] {
        let p = self.point(DVec2::new(x as f64 + 0.5, y as f64 + 0.5));
        [p.x as usize, p.y as usize, 0]
    }
}

fn flow(k: [f64; 4], p: DVec2) -> DVec2 {
    let turn = std::f64::consts::TAU / SIDE as f64;
    DVec2::new((turn * p.y + k[0]).sin() + k[1], (2.0 * turn * p.x + k[2]).cos() * k[3]) * 0.02
}

fn box_of(operator: Operator, walls: bool, smagorinsky: Option<f64>, k: [f64; 4], map: Symmetry) -> Lbm2 {
    let mut setup = Setup::new([SIDE, SIDE, 1], 1.0, 1.0, 0.55);
    setup.operator = operator;
    setup.smagorinsky = smagorinsky;
    setup.acceleration = map.vector(DVec2::new(3e-4, -1e-4));
    let centre = map.point(DVec2::new(4.3, 5.1));
    setup.obstacles.push(Obstacle::new("disk", Ball { centre, radius: 2.2 }));
    if walls {
        let lid = Face::Wall(map.vector(DVec2::new(0.1, 0.0)));
        let mut faces = [[Face::REST, Face::REST], [Face::FreeSlip, lid]];
        if map.exchange {
            faces.swap(0, 1);
        }
        for (faces, mirrored) in faces.iter_mut().zip(map.mirror) {
            if mirrored {
                faces.swap(0, 1);
            }
        }
        let [x, y] = faces;
        (setup.faces[0], setup.faces[1]) = (x, y);
    }
    let inverse = move |p: DVec2| {
        let p = p - DVec2::splat(0.5 * SIDE as f64);
        let p = DVec2::new(if map.mirror[0] { -p.x } else { p.x }, if map.mirror[1] { -p.y } else { p.y });
        let p = if map.exchange { DVec2::new(p.y, p.x) } else { p };
        p + DVec2::splat(0.5 * SIDE as f64)
    };
    let mut lbm = Lbm2::new(setup).unwrap();
    lbm.set_flow(|p| Flow { pressure: 0.0, velocity: map.vector(flow(k, inverse(p))) });
    lbm
}

fn operators() -> impl Strategy<Value = Operator> {
    prop::sample::select(vec![
        Operator::SingleRelaxation,
        Operator::TwoRelaxation { magic: 0.25 },
        Operator::EXACT_WALLS,
        Operator::Regularised,
    ])
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, ..ProptestConfig::default() })]

    #[test]
    fn a_mirrored_or_turned_flow_stays_so(
        operator in operators(),
        walls: bool,
        closure: bool,
        k in prop::array::uniform4(-1.0..1.0_f64),
        exchange: bool,
        mirror: [bool; 2],
    ) {
        let map = Symmetry { exchange, mirror };
        let same = Symmetry { exchange: false, mirror: [false; 2] };
        let smagorinsky = closure.then_some(0.15);
        let mut first = box_of(operator, walls, smagorinsky, k, same);
        let mut second = box_of(operator, walls, smagorinsky, k, map);
        let dt = first.setup().time_step;
        first.advance(dt, 60).unwrap();
        second.advance(dt, 60).unwrap();
        let scale = first.setup().lattice_speed();
        for (x, y) in (0..SIDE).flat_map(|x| (0..SIDE).map(move |y| (x, y))) {
            let (a, b) = (first.flow([x, y, 0]), second.flow(map.cell([x, y])));
            prop_assert_eq!(a.is_some(), b.is_some());
            if let (Some(a), Some(b)) = (a, b) {
                prop_assert!((map.vector(a.velocity) - b.velocity).length() < 1e-12 * scale);
            }
        }
        let (a, b) = (first.force_on(0), second.force_on(0));
        prop_assert!((map.vector(a) - b).length() < 1e-9 * (1.0 + a.length()), "{a} {b}");
    }

    /// Half-way walls, at rest or moving along themselves, let nothing in or out.
    #[test]
    fn mass_is_kept_between_half_way_walls(operator in operators(), k in prop::array::uniform4(-1.0..1.0_f64)) {
        let same = Symmetry { exchange: false, mirror: [false; 2] };
        let mut setup = box_of(operator, true, None, k, same).setup().clone();
        setup.obstacles[0].wall = WallScheme::HalfWay;
        let mut lbm = Lbm2::new(setup).unwrap();
        let before = lbm.excess();
        lbm.advance(lbm.setup().time_step, 2000).unwrap();
        let cells = (SIDE * SIDE) as f64;
        prop_assert!((lbm.excess() - before).abs() < 1e-12 * cells, "{}", lbm.excess() - before);
    }
}

/// A snapshot does not depend on where populations lie.
#[test]
fn parities_of_the_layout_save_the_same_bytes() {
    let same = Symmetry { exchange: false, mirror: [false; 2] };
    let at = |steps: u64| {
        let mut lbm = box_of(Operator::EXACT_WALLS, true, None, [0.1, 0.2, 0.3, 0.4], same);
        lbm.advance(lbm.setup().time_step, steps).unwrap();
        lbm
    };
    for steps in [6, 7] {
        let mut saved = Section::new("solver");
        let first = at(steps);
        first.save(&mut saved);
        // A fresh solver is in the natural layout; after 6 steps it is too, after 7 it is not.
        let mut second = at(0);
        second.restore(&saved).unwrap();
        let mut again = Section::new("solver");
        second.save(&mut again);
        assert_eq!(saved, again);
    }
}
