//! Returns in principal stresses. Strengths are of the order of 1 and so are trial stresses.

use super::*;
use granular_core::random::Chance;

/// Friction, dilation (degrees), cohesion, Poisson's ratio.
const MATERIALS: [[f64; 4]; 7] = [
    [23.2, 0.0, 0.0, 0.23],
    [23.2, 0.0, 1.0, 0.23],
    [35.0, 10.0, 0.5, 0.3],
    [30.0, 30.0, 1.0, 0.0],
    [0.0, 0.0, 1.0, 0.45],
    [60.0, 5.0, 0.2, -0.3],
    [10.0, 10.0, 0.0, 0.49],
];

fn material([friction, dilation, cohesion, poisson]: [f64; 4]) -> MohrCoulomb {
    let strength =
        Strength { friction_angle: friction.to_radians(), dilation_angle: dilation.to_radians(), cohesion };
    MohrCoulomb::new(LinearElastic::new(100.0, poisson).unwrap(), strength).unwrap()
}

fn sorted(chance: &mut Chance) -> [f64; 3] {
    let center = chance.between(-5.0, 3.0);
    let size = 10.0_f64.powf(chance.between(-3.0, 0.5));
    let mut values = [0, 1, 2].map(|_| center + size * chance.between(-1.0, 1.0));
    match (chance.uniform() * 8.0) as u32 {
        0 => values[1] = values[0],
        1 => values = [values[0]; 3],
        _ => {}
    }
    values.sort_by(|a, b| b.total_cmp(a));
    values
}

/// Flows of all faces on which a stress lies.
fn flows<const CUT: bool>(law: &MohrCoulomb<CUT>, s: [f64; 3]) -> Vec<[f64; 3]> {
    let Pyramid { k, m, y, .. } = law.pyramid;
    let mut found = Vec::new();
    for (i, j) in [(0, 1), (0, 2), (1, 0), (1, 2), (2, 0), (2, 1)] {
        if (k * s[i] - s[j] - y).abs() < 1e-9 {
            let mut flow = [0.0; 3];
            (flow[i], flow[j]) = (m, -1.0);
            found.push(flow);
        }
    }
    for i in 0..3 {
        if CUT && (s[i] - law.cut.tension).abs() < 1e-9 {
            let mut flow = [0.0; 3];
            flow[i] = 1.0;
            found.push(flow);
        }
    }
    found
}

/// Factors of at least zero with which at most three of the flows add up to the strain.
fn is_in_cone(flows: &[[f64; 3]], strain: [f64; 3], tolerance: f64) -> bool {
    use granular_core::glam::{DMat3, DVec3};
    let strain = DVec3::from_array(strain);
    let flow = |i: usize| DVec3::from_array(flows[i]);
    let n = flows.len();
    let one = |i: usize| {
        let factor = strain.dot(flow(i)) / flow(i).dot(flow(i));
        factor >= -tolerance && (strain - flow(i) * factor).length() <= tolerance
    };
    let several = |i: usize, j: usize, third: DVec3, third_is_flow: bool| {
        let matrix = DMat3::from_cols(flow(i), flow(j), third);
        if matrix.determinant().abs() < 1e-6 {
            return false;
        }
        let factors = matrix.inverse() * strain;
        let last = if third_is_flow { factors.z >= -tolerance } else { factors.z.abs() <= tolerance };
        factors.x >= -tolerance && factors.y >= -tolerance && last
    };
    (0..n).any(one)
        || (0..n).any(|i| {
            (i + 1..n).any(|j| {
                several(i, j, flow(i).cross(flow(j)), false)
                    || (j + 1..n).any(|k| several(i, j, flow(k), true))
            })
        })
}

fn check<const CUT: bool>(law: &MohrCoulomb<CUT>, b: [f64; 3]) -> Returned {
    let returned = law.returned(b);
    let s = returned.values;
    assert!(s[0] >= s[1] - 1e-13 && s[1] >= s[2] - 1e-13, "{law:?}: {b:?} to {s:?}");
    assert!(law.excess(s).abs() < 1e-12, "{law:?}: {b:?} to {s:?}, beyond by {}", law.excess(s));
    let lost = law.pyramid.strain([b[0] - s[0], b[1] - s[1], b[2] - s[2]]);
    // Without dilation no sum of flows has a volumetric part, yet material separates at the apex.
    let mut flows = flows(law, s);
    if returned.at_tip {
        flows.push([1.0; 3]);
        flows.extend(
            [[1.0, 1.0, -2.0], [-2.0, 1.0, 1.0], [1.0, -2.0, 1.0]].iter().filter(|_| law.pyramid.m == 1.0),
        );
    }
    let strain = lost.map(|part| part * 100.0);
    assert!(is_in_cone(&flows, strain, 1e-9), "{law:?}: {b:?} to {s:?}, strain {strain:?}, {flows:?}");
    assert!(law.pyramid.work(s, [0, 1, 2].map(|i| b[i] - s[i])) >= -1e-13, "{b:?} to {s:?}");
    returned
}

#[test]
fn returned_stress_is_on_the_surface_and_plastic_strain_in_the_cone_of_its_flows() {
    let mut chance = Chance::new(11);
    for constants in MATERIALS {
        let law = material(constants);
        let mut at_tip = 0;
        for _ in 0..20_000 {
            let b = sorted(&mut chance);
            if law.excess(b) > 0.0 {
                at_tip += u32::from(check(&law, b).at_tip);
            }
        }
        assert!(at_tip > 100 || law.pyramid.apex > 1.5, "{at_tip}");
    }
}

#[test]
fn with_a_tensile_strength_too() {
    let mut chance = Chance::new(12);
    for constants in MATERIALS {
        let law = material(constants);
        if law.pyramid.apex == 0.0 {
            continue;
        }
        for share in [0.0, 0.3, 0.9] {
            let law = law.with_tensile_strength(share * law.pyramid.apex.min(1.5)).unwrap();
            for _ in 0..20_000 {
                let b = sorted(&mut chance);
                if law.excess(b) > 0.0 {
                    check(&law, b);
                }
            }
        }
    }
}

/// The return is linear in pieces: the greatest factor of one of them.
fn steepest_piece(pyramid: &Pyramid, poisson: f64) -> f64 {
    let slopes = [pyramid.k, 0.0, -1.0];
    let row = |i: usize| {
        (0..3).map(|j| (f64::from(u8::from(i == j)) - pyramid.fall[i] * slopes[j]).abs()).sum::<f64>()
    };
    let plane = (0..3).map(row).fold(1.0, f64::max);
    let edges = pyramid.edges.map(|(weights, _)| pyramid.k * weights.iter().map(|w| w.abs()).sum::<f64>());
    plane.max(edges[0]).max(edges[1]).max(1.0 + poisson / (1.0 - poisson)).max(1.0 + 2.0 * poisson)
}

/// A small change of the trial stress changes the stress little, also from one region to the next.
#[test]
fn the_return_is_continuous() {
    fn steepest<const CUT: bool>(law: &MohrCoulomb<CUT>, chance: &mut Chance) -> f64 {
        let stress = |b: [f64; 3]| if law.excess(b) > 0.0 { law.returned(b).values } else { b };
        let mut steepest: f64 = 0.0;
        for _ in 0..20_000 {
            // From one trial stress to another in steps: each boundary on the way is crossed.
            let (from, to) = (sorted(chance), sorted(chance));
            let at = |t: f64| [0, 1, 2].map(|i| from[i] + t * (to[i] - from[i]));
            let t = chance.uniform();
            let (one, two) = (at(t), at(t + 1e-6));
            let distance = |a: [f64; 3], b: [f64; 3]| (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, f64::max);
            let moved = distance(one, two);
            // Where round-off does not count.
            if moved > 1e-8 {
                steepest = steepest.max(distance(stress(one), stress(two)) / moved);
            }
        }
        steepest
    }
    let mut chance = Chance::new(13);
    for constants in MATERIALS {
        let law = material(constants);
        let bound = 1.001 * steepest_piece(&law.pyramid, constants[3]);
        let found = steepest(&law, &mut chance);
        assert!(found < bound, "{constants:?}: {found}");
        if law.pyramid.apex > 0.0 {
            let cut = law.with_tensile_strength(0.5 * law.pyramid.apex.min(1.5)).unwrap();
            let found = steepest(&cut, &mut chance);
            assert!(found < bound, "{constants:?}: {found}");
        }
    }
}

/// On the borders between regions themselves.
#[test]
fn both_sides_of_a_border_return_to_the_same_stress() {
    let mut chance = Chance::new(14);
    for constants in MATERIALS {
        let law = material(constants);
        for _ in 0..2000 {
            let (from, to) = (sorted(&mut chance), sorted(&mut chance));
            let at = |t: f64| [0, 1, 2].map(|i| from[i] + t * (to[i] - from[i]));
            let region = |t: f64| {
                let b = at(t);
                let plane = law.pyramid.on_plane(b);
                let returned = law.returned(b);
                (
                    law.excess(b) > 0.0,
                    plane[0] >= plane[1] && plane[1] >= plane[2],
                    law.pyramid.meets_first_edge(b),
                    returned.at_tip,
                )
            };
            let (mut low, mut high) = (0.0, 1.0);
            if region(low) == region(high) {
                continue;
            }
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if region(middle) == region(low) { low = middle } else { high = middle }
            }
            let stress = |t: f64| if law.excess(at(t)) > 0.0 { law.returned(at(t)).values } else { at(t) };
            let (one, two) = (stress(low), stress(high));
            assert!(
                (0..3).all(|i| (one[i] - two[i]).abs() < 1e-12),
                "{constants:?} {:?}: {one:?} {two:?}",
                at(low)
            );
        }
    }
}

#[test]
fn what_no_material_has_is_refused() {
    let elastic = LinearElastic::new(1e6, 0.3).unwrap();
    let refused = |friction: f64, dilation: f64, cohesion: f64| {
        let (friction_angle, dilation_angle) = (friction.to_radians(), dilation.to_radians());
        MohrCoulomb::new(elastic, Strength { friction_angle, dilation_angle, cohesion })
            .unwrap_err()
            .to_string()
    };
    assert!(refused(90.0, 0.0, 0.0).starts_with("angle of friction in degrees is 90, but"));
    assert!(refused(f64::NAN, 0.0, 0.0).starts_with("angle of friction"));
    assert!(refused(-1.0, 0.0, 0.0).starts_with("angle of friction"));
    assert!(refused(20.0, 21.0, 0.0).starts_with("angle of dilation"));
    assert!(refused(20.0, -1.0, 0.0).starts_with("angle of dilation"));
    assert!(refused(20.0, 0.0, -1.0).starts_with("cohesion is -1"));
    assert!(
        refused(0.0, 0.0, 0.0)
            .starts_with("cohesion is 0, but must be above 0 Pa where there is no friction")
    );
    let sand = MohrCoulomb::new(elastic, Strength::of_friction(0.5)).unwrap();
    assert!(sand.with_tensile_strength(0.0).is_err(), "sand has no tension to cut");
}
