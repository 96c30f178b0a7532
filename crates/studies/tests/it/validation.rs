//! The quick form of `granular validate`: every required row of every case passes.

mod ball_on_incline;
mod bouncing_ball;
mod carried_disk;
mod cavity;
mod chain_waves;
mod chung_ooi;
mod coarse_graining;
mod column_density;
mod column_runout;
mod column_studies;
mod contact_time;
mod couette;
mod critical_state;
mod cylinder;
mod disk_in_channel;
mod disk_on_incline;
mod energy_balance;
mod flat_surface;
mod fluid_mass;
mod grading;
mod hertz_impact;
mod hydrostatic;
mod lattice_moduli;
mod momentum;
mod moving_walls;
mod oblique_impact;
mod packing_density;
mod periodic_cell;
mod poiseuille;
mod regular_packings;
mod restitution;
mod rotating_frame;
mod sample_densities;
mod sliding_to_rolling;
mod slope_impact;
mod square_array;
mod taylor_green;
mod tessellation;
mod vortex_street;
mod wall_forces;
mod wall_in_channel;
mod womersley;

use granular_studies::validate::{CASES, Effort, find, table};

/// Runs one case and fails with its table when a required row does.
fn passes(name: &str) {
    let case = find(Some(name)).unwrap().into_iter().find(|case| case.name == name).unwrap();
    let rows = case.run(Effort::Quick);
    assert!(rows.iter().any(|row| row.gate), "{name} requires nothing");
    assert!(rows.iter().all(|row| row.pass || !row.gate), "{}", table(&rows));
}

#[test]
fn every_case_has_a_module_and_a_folder() {
    let here = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    for case in CASES {
        assert!(here.join(format!("tests/it/validation/{}.rs", case.name)).is_file(), "{}", case.name);
        let folder = here.join("../../validation").join(case.name);
        let text = std::fs::read_to_string(folder.join("README.md")).unwrap();
        for part in ["Evidence", "Source", "Set-up", "Weakness"] {
            assert!(text.contains(&format!("- {part}:")), "{}: {part}", case.name);
        }
    }
}
