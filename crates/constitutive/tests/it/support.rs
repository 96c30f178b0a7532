//! All laws, and how to ask one of them.

use granular_constitutive::granular_core::SymmetricTensor;
use granular_constitutive::{
    AnyLaw, Axes, Bingham, ConeMatch, ConstitutiveLaw, DruckerPrager, Grains, Increment, LawVisitor,
    LinearElastic, LinearFriction, MohrCoulomb, MuI, Newtonian, NorSand, NorSandConstants, NorSandState,
    PressureElastic, Response, SaturatingFriction, Strength, Tait,
};
use std::marker::PhantomData;

/// Moduli are of the order of 1e6 Pa, strengths of 1e3 Pa.
pub(crate) fn solids() -> Vec<AnyLaw> {
    let elastic = LinearElastic::new(1.98e6, 0.23).unwrap();
    let dry = Strength::of_friction(23.2_f64.to_radians());
    let dilatant = Strength { dilation_angle: 0.2, ..dry };
    let cohesive = Strength { cohesion: 1e3, ..dilatant };
    let tresca = Strength { cohesion: 1e3, ..Strength::of_friction(0.0) };
    let mohr_coulomb = |strength| MohrCoulomb::new(elastic, strength).unwrap();
    let drucker_prager = |strength, cone| DruckerPrager::new(elastic, strength, cone).unwrap();
    let grains = Grains::Dry { diameter: 1e-3, density: 2500.0 };
    let linear = LinearFriction::new(0.22, 1.0).unwrap();
    vec![
        elastic.into(),
        mohr_coulomb(dry).into(),
        mohr_coulomb(dilatant).into(),
        mohr_coulomb(cohesive).into(),
        mohr_coulomb(tresca).into(),
        mohr_coulomb(cohesive).with_tensile_strength(500.0).unwrap().into(),
        mohr_coulomb(cohesive).with_tensile_strength(0.0).unwrap().into(),
        drucker_prager(dry, ConeMatch::PlaneStrain).into(),
        drucker_prager(cohesive, ConeMatch::Compression).into(),
        drucker_prager(tresca, ConeMatch::Extension).into(),
        MuI::new(elastic, linear, grains).unwrap().into(),
        MuI::new(elastic, SaturatingFriction::glass_beads(), Grains::InLiquid { viscosity: 1.0 })
            .unwrap()
            .into(),
        nor_sand().into(),
    ]
}

pub(crate) fn nor_sand() -> NorSand {
    let constants = NorSandConstants {
        critical_ratio: 1.25,
        critical_void_ratio: 0.82,
        critical_slope: 0.015,
        coupling: 0.3,
        dilation_limit: 3.5,
        hardening: 150.0,
    };
    let elastic = PressureElastic::new(10e6, 100e3, 0.2, 0.5, 1e6).unwrap();
    NorSand::new(elastic, constants, NorSandState { void_ratio: 0.7, image_pressure: 1e3 }).unwrap()
}

pub(crate) fn laws() -> Vec<AnyLaw> {
    let state = Tait::new(1000.0, 30.0).unwrap();
    let mut laws = solids();
    laws.push(Newtonian::new(2.0, state).unwrap().into());
    laws.push(Bingham::new(2.0, 50.0, 10.0, state.without_tension()).unwrap().into());
    laws
}

/// The memory that a law starts with.
pub(crate) fn start(law: &AnyLaw) -> Vec<f64> {
    struct Start;
    impl LawVisitor for Start {
        type Output = Vec<f64>;
        fn visit<L: ConstitutiveLaw>(self, law: &L) -> Vec<f64> {
            law.start().as_ref().to_vec()
        }
    }
    law.visit(Start)
}

struct Ask<'a, A> {
    stress: SymmetricTensor,
    memory: &'a mut [f64],
    increment: &'a Increment,
    axes: PhantomData<A>,
}

impl<A: Axes> LawVisitor for Ask<'_, A> {
    type Output = Response;
    fn visit<L: ConstitutiveLaw>(self, law: &L) -> Response {
        let mut memory = law.start();
        memory.as_mut().copy_from_slice(self.memory);
        let response = law.respond::<A>(self.stress, &mut memory, self.increment);
        self.memory.copy_from_slice(memory.as_ref());
        response
    }
}

pub(crate) fn respond<A: Axes>(
    law: &AnyLaw,
    stress: SymmetricTensor,
    memory: &mut [f64],
    increment: &Increment,
) -> Response {
    law.visit(Ask::<A> { stress, memory, increment, axes: PhantomData })
}

pub(crate) fn stored(law: &AnyLaw, stress: SymmetricTensor) -> f64 {
    struct Stored(SymmetricTensor);
    impl LawVisitor for Stored {
        type Output = f64;
        fn visit<L: ConstitutiveLaw>(self, law: &L) -> f64 {
            law.stored_energy(self.0, &law.start())
        }
    }
    law.visit(Stored(stress))
}

pub(crate) fn norm(tensor: SymmetricTensor) -> f64 {
    tensor.contract(tensor).sqrt()
}
