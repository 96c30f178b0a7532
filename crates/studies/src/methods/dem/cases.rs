//! Validation cases of grains.

mod boundaries;
mod coarse;
pub(super) mod collapse;
mod columns;
mod conservation;
mod frames;
pub(super) mod hertz;
pub(super) mod impact;
mod incline;
mod lattices;
mod laws;
mod oblique;
mod packing;
mod packing_density;
mod plane;
mod recorded;
pub(super) mod restitution;
mod rolling;
mod run_out;
mod shear;
mod slope_impact;
pub(super) mod strike;

use crate::validate::cases;

cases! { "dem";
    disk_on_incline: "a disk slips or rolls down 45 degrees" => incline::disk;
    ball_on_incline: "a sphere slips or rolls down 45 degrees" => incline::sphere;
    restitution: "restitution for both treatments of tension" => restitution::error;
    contact_time: "contact time and largest overlap" => restitution::contact;
    hertz_impact: "impacts of elastic grains and their order" => hertz::impact;
    chung_ooi: "benchmark impacts 1 to 4 and 7" => hertz::chung_ooi;
    oblique_impact: "gross sliding and sticking on a plane" => oblique::run;
    sliding_to_rolling: "when and how fast a ball rolls" => rolling::run;
    bouncing_ball: "heights of a bouncing ball" => rolling::bounces;
    momentum: "momentum of free collisions" => conservation::momentum;
    sample_densities: "samples of a wanted density" => packing::densities;
    wall_forces: "stress of contacts and forces on walls" => boundaries::wall_forces;
    moving_walls: "pistons, belts, lids under a force" => boundaries::moving_walls;
    flat_surface: "a flat strip of parts is a plane" => boundaries::flat_surface;
    energy_balance: "energy balance of a collapse" => conservation::energy;
    packing_density: "density of the bulk from Voronoi cells, over the threshold of the free surface" =>
        packing_density::run;
    coarse_graining: "continuum fields from grains" => coarse::run;
    regular_packings: "strength of lattices of grains" => lattices::strength;
    lattice_moduli: "elastic moduli of lattices of grains" => lattices::moduli;
    chain_waves: "waves on a chain of grains" => lattices::waves;
    periodic_cell: "shifts of a periodic cell, and its stress" => frames::shifts;
    rotating_frame: "a turned and a turning frame" => frames::rotation;
    critical_state: "shear of the grains of the thesis" => shear::run;
    slope_impact: "a pile is pushed: energy, momentum, run-out, decay" => slope_impact::run;
    column_runout: "run-out of a column of aspect ratio 0.8" => run_out::run_out;
    column_studies: "columns over their aspect ratio: run-out, height, flow, energies" => columns::run;
    column_density: "dense and loose columns" => columns::density;
}
