use super::*;

/// From `restitution_linear_dashpot.csv` (closed form checked against integration to 1e-8):
/// restitution of the full half period, damping ratio, restitution and duration times frequency
/// with the tension cut.
const TABLE: &[[f64; 4]] = &[
    [0.99, 0.00319910, 0.99002026, 3.13521048],
    [0.9, 0.03351845, 0.90202607, 3.07627176],
    [0.75, 0.09119051, 0.76264865, 2.97133810],
    [0.5, 0.21545376, 0.55028317, 2.77239197],
    [0.3, 0.35785713, 0.39714050, 2.58054145],
    [0.1, 0.59115503, 0.25272938, 2.32669254],
];

#[test]
fn both_closed_forms_agree_with_the_table() {
    for &[kept, zeta, cut, duration] in TABLE {
        assert!((restitution_of_damping(zeta, Tension::Kept) - kept).abs() < 1e-7);
        assert!((restitution_of_damping(zeta, Tension::Cut) - cut).abs() < 1e-7);
        assert!((contact_phase(zeta, Tension::Cut) - duration).abs() < 1e-7);
    }
}

#[test]
fn damping_inverts_restitution_down_to_overdamped_contacts() {
    for tension in [Tension::Cut, Tension::Kept] {
        for restitution in [1.0, 0.999, 0.75, 0.3, 0.05, 1e-3] {
            let zeta = damping_for_restitution(restitution, tension);
            let back = restitution_of_damping(zeta, tension);
            assert!((back - restitution).abs() < 1e-9, "{tension:?} {restitution} -> {zeta} -> {back}");
        }
    }
    assert!((damping_for_restitution(0.75, Tension::Cut) - 0.097158).abs() < 1e-6);
}

#[test]
fn the_cut_form_is_smooth_through_critical_damping() {
    let at = |zeta| restitution_of_damping(zeta, Tension::Cut);
    assert!((at(1.0) - (-2.0_f64).exp()).abs() < 1e-9);
    assert!((at(1.0 - 1e-7) - at(1.0 + 1e-7)).abs() < 1e-6);
}

#[test]
fn equal_materials_keep_their_stiffness_and_bad_ones_are_refused() {
    let glass = Material::default();
    let pair = PairProperties::mix(&glass, &glass);
    assert_eq!(pair.normal_stiffness, glass.normal_stiffness);
    let wall = Material { friction: 0.466, normal_stiffness: 4e6, ..glass };
    assert_eq!(PairProperties::mix(&glass, &wall).friction, 0.466);
    let mut materials = Materials::new();
    let error = materials.add(Material { restitution: 0.0, ..glass }).unwrap_err();
    assert_eq!(error.to_string(), "restitution is 0, but must be above 0 and at most 1");
    assert!(materials.add(Material { density: f64::NAN, ..glass }).is_err());
}
