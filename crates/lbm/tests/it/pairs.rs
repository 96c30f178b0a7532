//! Two steps in one pass over memory give the bits of one step at a time.

use granular_core::glam::DVec2;
use granular_core::{Section, Solver, StepError};
use granular_lbm::*;
use proptest::prelude::*;

fn in_pool<T: Send>(threads: usize, body: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(body)
}

/// Faces of a scene, by number: a lid over a channel, free slip around, periodic everywhere, a lid beside free slip.
fn scene(rows: usize, faces: usize, wall: WallScheme, body_at: f64) -> Setup<granular_core::D2> {
    let mut setup = Setup::new([33, rows, 1], 1e-3, 1e-6, 0.53);
    let lid = Face::Wall(DVec2::new(0.003, 0.0));
    setup.faces = match faces {
        0 => [[Face::Periodic, Face::Periodic], [Face::REST, lid], setup.faces[2].clone()],
        1 => [[Face::FreeSlip, Face::FreeSlip], [Face::FreeSlip, Face::FreeSlip], setup.faces[2].clone()],
        2 => [[Face::Periodic, Face::Periodic], [Face::Periodic, Face::Periodic], setup.faces[2].clone()],
        _ => [[Face::REST, Face::FreeSlip], [lid, Face::FreeSlip], setup.faces[2].clone()],
    };
    setup.smagorinsky = (faces % 2 == 1).then_some(0.1);
    setup.acceleration = DVec2::new(1e-4, -2e-4);
    for (at, radius) in [(body_at, 0.0042), (body_at + 0.37, 0.0031)] {
        let centre = DVec2::new(0.033 * (0.3 + at).fract(), rows as f64 * 1e-3 * at.fract());
        let mut body = Obstacle::new(format!("disk of {radius}"), Ball { centre, radius });
        (body.wall, body.velocity, body.spin) = (wall, DVec2::new(0.0004, -0.0007), 0.3);
        setup.obstacles.push(body);
    }
    setup
}

/// State and forces after steps in groups.
fn after<T: Real>(setup: Setup<granular_core::D2>, groups: &[u64], threads: usize) -> (Section, Vec<DVec2>) {
    let mut lbm = Lbm::<D2Q9, 9, T>::new(setup).unwrap();
    let dt = lbm.setup().time_step;
    in_pool(threads, || groups.iter().try_for_each(|&steps| lbm.advance(dt, steps))).unwrap();
    let mut section = Section::default();
    lbm.save(&mut section);
    (section, (0..2).map(|body| lbm.force_on(body)).collect())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn steps_in_pairs_have_the_bits_of_single_ones(
        rows in 12_usize..90,
        faces in 0_usize..4,
        wall in prop::sample::select(vec![WallScheme::HalfWay, WallScheme::Bouzidi, WallScheme::Yu]),
        body_at in 0.0..1.0_f64,
        threads in 1_usize..4,
    ) {
        let run = |groups: &[u64], threads| after::<f64>(scene(rows, faces, wall, body_at), groups, threads);
        let expected = run(&[1; 11], 1);
        prop_assert!(expected.1.iter().any(|force| force.length() > 0.0));
        for groups in [&[11][..], &[1, 10], &[5, 6], &[3, 4, 4]] {
            let found = run(groups, threads);
            prop_assert!(found == expected, "{groups:?}");
        }
        let single = |groups: &[u64], threads| after::<f32>(scene(rows, faces, wall, body_at), groups, threads);
        prop_assert!(single(&[11], threads) == single(&[1; 11], 1));
    }
}

/// The longest slabs: more rows than 64 times 16.
#[test]
fn pairs_in_many_slabs() {
    for rows in [1024, 1025, 1091] {
        let run = |groups: &[u64], threads| {
            after::<f64>(scene(rows, 0, WallScheme::Bouzidi, 0.4991), groups, threads)
        };
        let expected = run(&[1; 7], 1);
        for threads in [1, 2] {
            assert!(run(&[7], threads) == expected, "{rows} rows, {threads} threads");
        }
    }
}

/// A flow that blows up is refused within a step of where it would be alone.
#[test]
fn a_pair_refuses_what_single_steps_refuse() {
    let refused_at = |group: u64| {
        let mut setup = scene(40, 3, WallScheme::HalfWay, 0.3);
        setup.acceleration = DVec2::new(40.0, 0.0);
        let mut lbm = Lbm2::new(setup).unwrap();
        let dt = lbm.setup().time_step;
        let mut section = Section::default();
        let error = (0..4000 / group).find_map(|_| lbm.advance(dt, group).err()).expect("it blows up");
        assert!(matches!(error, StepError::TooStiff { .. } | StepError::NotFinite { .. }), "{error}");
        lbm.save(&mut section);
        section.one::<u64>("steps").unwrap()
    };
    let alone = refused_at(1);
    assert!((alone..=alone + 1).contains(&refused_at(4000)), "{alone}");
}
