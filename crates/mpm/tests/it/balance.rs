//! What the method keeps: mass, momentum, and the laws of motion in another frame.

use crate::sample::{SCHEMES, SHAPES, alone, tumbling};
use granular_constitutive::LinearElastic;
use granular_core::glam::DVec2;
use granular_core::{D2, D3, Dim, Linear, Solver, SymmetricTensor};
use granular_mpm::{Mpm, Options, Particle, Setup, VelocityUpdate};

fn choices() -> impl Iterator<Item = Options> {
    let of = move |(shape, velocity_update)| {
        SCHEMES.into_iter().map(move |scheme| Options {
            shape,
            scheme,
            velocity_update,
            ..Options::default()
        })
    };
    let flip = SHAPES.into_iter().map(|shape| (shape, VelocityUpdate::default()));
    let affine = SHAPES[1..].iter().map(|&shape| (shape, VelocityUpdate::Apic));
    flip.chain(affine).flat_map(of)
}

fn keeps_momentum<D: Dim>(side: f64) {
    for options in choices() {
        let mut mpm = tumbling::<D>(options, side);
        let (mass, momentum) = (mpm.mass(), mpm.momentum());
        mpm.advance(1e-3, 200).unwrap();
        assert_eq!(mpm.mass(), mass);
        let drift = (mpm.momentum() - momentum).length() / momentum.length();
        assert!(drift < 1e-12, "{options:?}: {drift}");
    }
}

#[test]
fn momentum_is_kept_to_round_off() {
    alone(|| {
        keeps_momentum::<D2>(1.0);
        keeps_momentum::<D3>(0.4);
    });
}

/// Largest distance of particles of one simulation from those of another, brought into its frame.
fn distance<D: Dim>(one: &Mpm<D>, other: &Mpm<D>, frame: impl Fn(D::Vec) -> D::Vec) -> f64 {
    let mut places = vec![D::Vec::ZERO; one.len()];
    one.particles().for_each(|(id, particle)| places[id as usize] = particle.position);
    let far = |(id, particle): (u32, granular_mpm::Particle<D>)| {
        (frame(particle.position) - places[id as usize]).length()
    };
    other.particles().map(far).fold(0.0, f64::max)
}

/// Of a scene that is mirrored about the middle of a cell line, every particle does what its mirror image does.
#[test]
fn a_mirrored_scene_stays_mirrored() {
    for options in choices() {
        let mut mpm = tumbling::<D2>(options, 1.0);
        let mut mirrored = Mpm::new(Setup { options, ..Setup::new(0.1) }).unwrap();
        let law = LinearElastic::new(1e4, 0.3).unwrap();
        let mut particles = vec![Particle::at(DVec2::ZERO, 1.0); mpm.len()];
        for (id, particle) in mpm.particles() {
            let flip = DVec2::new(-1.0, 1.0);
            particles[id as usize] = Particle {
                position: particle.position * flip,
                velocity: particle.velocity * flip,
                ..particle
            };
        }
        mirrored.body(law, 1000.0, &particles).unwrap();
        mpm.advance(1e-3, 100).unwrap();
        mirrored.advance(1e-3, 100).unwrap();
        let far = distance(&mpm, &mirrored, |at| DVec2::new(-at.x, at.y));
        assert!(far < 1e-12, "{options:?}: {far}");
    }
}

/// A body in uniform motion strains nothing and flies on, whatever nodes it passes.
#[test]
fn uniform_motion_is_kept() {
    alone(|| {
        for options in choices() {
            let mut mpm = Mpm::new(Setup { options, ..Setup::new(0.1) }).unwrap();
            let wind = DVec2::new(0.83, -0.41);
            let stress = SymmetricTensor::ZERO;
            let particles: Vec<_> = Particle::<D2>::filling(DVec2::ZERO, DVec2::splat(0.7), 0.05)
                .iter()
                .map(|particle| particle.moving(wind).stressed(stress))
                .collect();
            mpm.body(LinearElastic::new(1e4, 0.3).unwrap(), 1000.0, &particles).unwrap();
            mpm.advance(1e-3, 700).unwrap();
            for (id, particle) in mpm.particles() {
                let expected = particles[id as usize].position + wind * 0.7;
                assert!((particle.position - expected).length() < 1e-12, "{options:?}");
            }
        }
    });
}
