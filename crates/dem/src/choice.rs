//! Which contact law a set-up needs.

use crate::contacts::{Contacts, Pairs};
use crate::law::{
    Frictional, HertzMindlin, HertzNormal, LinearFrictional, LinearNormal, MaterialLaw, Rolling, Twisting,
};
use crate::material::Materials;
use crate::setup::{ContactModel, Options};
use granular_core::{Blocks, D2, D3, Dim};
use std::any::{Any, TypeId};

/// Whether anything turns grains.
pub(crate) fn needs_rotation(materials: &Materials) -> bool {
    materials
        .pairs()
        .any(|(.., pair)| pair.friction > 0.0 || pair.rolling_friction > 0.0 || pair.twisting_friction > 0.0)
}

/// Contacts of the least law that does what the materials say.
///
/// The kernels of all laws are compiled here, once for the plane and once for space, and not again
/// in every crate that builds a simulation.
pub(crate) fn choose_law<D: Dim>(
    materials: &Materials,
    options: &Options,
    blocks: Blocks,
    turning: bool,
) -> Box<dyn Pairs<D>> {
    let chosen: Box<dyn Any> = if TypeId::of::<D>() == TypeId::of::<D2>() {
        Box::new(in_plane(materials, options, blocks, turning))
    } else {
        Box::new(in_space(materials, options, blocks, turning))
    };
    *chosen.downcast::<Box<dyn Pairs<D>>>().expect("there are two dimensions")
}

#[inline(never)]
fn in_plane(materials: &Materials, options: &Options, blocks: Blocks, turning: bool) -> Box<dyn Pairs<D2>> {
    of_model::<D2>(materials, options, blocks, turning)
}

#[inline(never)]
fn in_space(materials: &Materials, options: &Options, blocks: Blocks, turning: bool) -> Box<dyn Pairs<D3>> {
    of_model::<D3>(materials, options, blocks, turning)
}

fn of_model<D: Dim>(
    materials: &Materials,
    options: &Options,
    blocks: Blocks,
    turning: bool,
) -> Box<dyn Pairs<D>> {
    match options.contact {
        ContactModel::Linear => {
            of_family::<D, LinearNormal, LinearFrictional>(materials, options, blocks, turning)
        }
        ContactModel::Hertz => of_family::<D, HertzNormal, HertzMindlin>(materials, options, blocks, turning),
    }
}

fn of_family<D: Dim, N: MaterialLaw<D>, F: Frictional<D>>(
    materials: &Materials,
    options: &Options,
    blocks: Blocks,
    turning: bool,
) -> Box<dyn Pairs<D>> {
    let tension = options.tension;
    // Disks cannot twist: nothing is remembered or computed for it.
    if D::TWISTS && materials.pairs().any(|(.., pair)| pair.twisting_friction > 0.0) {
        Box::new(Contacts::<D, Twisting<F>>::of_materials(materials, tension, blocks))
    } else if materials.pairs().any(|(.., pair)| pair.rolling_friction > 0.0) {
        Box::new(Contacts::<D, Rolling<F>>::of_materials(materials, tension, blocks))
    } else if turning {
        Box::new(Contacts::<D, F>::of_materials(materials, tension, blocks))
    } else {
        Box::new(Contacts::<D, N>::of_materials(materials, tension, blocks))
    }
}
