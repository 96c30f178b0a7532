//! Which contact law a set-up needs.

use crate::contacts::{Contacts, Pairs};
use crate::law::{
    ContactLaw, Frictional, HertzMindlin, HertzNormal, LinearFrictional, LinearNormal, Rolling, Twisting,
};
use crate::material::Materials;
use crate::setup::{ContactModel, Options};
use granular_core::{Blocks, Dim};

/// Whether anything turns grains.
pub(crate) fn needs_rotation(materials: &Materials) -> bool {
    materials
        .pairs()
        .any(|(.., pair)| pair.friction > 0.0 || pair.rolling_friction > 0.0 || pair.twisting_friction > 0.0)
}

/// Contacts of the least law that does what the materials say.
pub(crate) fn choose_law<D: Dim>(
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

fn of_family<D: Dim, N: ContactLaw<D>, F: Frictional<D>>(
    materials: &Materials,
    options: &Options,
    blocks: Blocks,
    turning: bool,
) -> Box<dyn Pairs<D>> {
    let tension = options.tension;
    // Disks cannot twist: nothing is remembered or computed for it.
    if D::TWISTS && materials.pairs().any(|(.., pair)| pair.twisting_friction > 0.0) {
        Box::new(Contacts::<D, Twisting<F>>::new(materials, tension, blocks))
    } else if materials.pairs().any(|(.., pair)| pair.rolling_friction > 0.0) {
        Box::new(Contacts::<D, Rolling<F>>::new(materials, tension, blocks))
    } else if turning {
        Box::new(Contacts::<D, F>::new(materials, tension, blocks))
    } else {
        Box::new(Contacts::<D, N>::new(materials, tension, blocks))
    }
}
