//! Changes of single grains, by their stable identifiers. The ledger counts the energy that they put in.

use super::{Dem, view_of};
use crate::contact::Partner;
use crate::material::SetupError;
use crate::view::View;
use granular_core::{Dim, Linear};

/// A body that a grain touches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OtherBody<'a> {
    /// A grain, by its stable identifier.
    Grain(u32),
    /// A wall, by its name.
    Wall(&'a str),
}

impl<D: Dim> Dem<D> {
    /// Puts a grain elsewhere \[m\]; in a periodic cell it is put back inside by whole edges.
    ///
    /// # Errors
    /// When there is no such grain or the position is not finite.
    pub fn set_position(&mut self, id: u32, position: D::Vec) -> Result<(), SetupError> {
        let index = self.index_of(id)?;
        expect(position.is_finite(), "position", id, f64::NAN, "finite")?;
        self.change(|dem| {
            dem.grains.position[index] = position;
            dem.put_back_inside();
        });
        Ok(())
    }

    /// Gives a grain a velocity \[m/s\]; in a cell that deforms, relative to its flow.
    ///
    /// # Errors
    /// When there is no such grain, it is fixed, or the velocity is not finite.
    pub fn set_velocity(&mut self, id: u32, velocity: D::Vec) -> Result<(), SetupError> {
        let index = self.index_of(id)?;
        expect(velocity.is_finite(), "velocity", id, f64::NAN, "finite")?;
        expect(
            !self.is_fixed_at(index),
            "velocity",
            id,
            velocity.length(),
            "given to a grain that is not fixed",
        )?;
        self.change(|dem| dem.grains.velocity[index] = velocity);
        Ok(())
    }

    /// Gives a grain an angular velocity \[rad/s\].
    ///
    /// # Errors
    /// When there is no such grain, it is fixed, or the spin is not finite.
    pub fn set_spin(&mut self, id: u32, spin: D::Spin) -> Result<(), SetupError> {
        let index = self.index_of(id)?;
        expect(spin.is_finite(), "spin", id, f64::NAN, "finite")?;
        expect(!self.is_fixed_at(index), "spin", id, spin.length(), "given to a grain that is not fixed")?;
        self.change(|dem| {
            dem.let_turn();
            dem.grains.spin[index] = spin;
        });
        Ok(())
    }

    /// Gives a grain a mass of its own \[kg; kg/m in the plane\] in place of that of its material. Its moment of inertia
    /// changes in proportion.
    ///
    /// # Errors
    /// When there is no such grain or the mass is not positive and finite.
    pub fn set_mass(&mut self, id: u32, mass: f64) -> Result<(), SetupError> {
        let index = self.index_of(id)?;
        expect(mass.is_finite() && mass > 0.0, "mass", id, mass, "positive and finite")?;
        self.change(|dem| dem.grains.set_mass(index, mass));
        Ok(())
    }

    /// Gives a grain a moment of inertia of its own \[kg m^2; kg m in the plane\] in place of that of a uniform ball.
    ///
    /// # Errors
    /// When there is no such grain or the moment is not positive and finite.
    pub fn set_inertia(&mut self, id: u32, inertia: f64) -> Result<(), SetupError> {
        let index = self.index_of(id)?;
        expect(
            inertia.is_finite() && inertia > 0.0,
            "moment of inertia",
            id,
            inertia,
            "positive and finite",
        )?;
        self.change(|dem| dem.grains.set_inertia(index, inertia));
        Ok(())
    }

    /// Stops a grain and holds it in its place, or lets it go. Others meet it like a wall of its shape: the effective mass of
    /// a contact is that of the other grain. In a cell that deforms it goes with the flow of the cell.
    ///
    /// # Errors
    /// When there is no such grain.
    pub fn set_fixed(&mut self, id: u32, fixed: bool) -> Result<(), SetupError> {
        let index = self.index_of(id)?;
        self.change(|dem| dem.grains.set_fixed(index, fixed, dem.gravity));
        Ok(())
    }

    /// Sets the tangential spring of a contact that there is: the displacement \[m\] of the grain past the other body, of which
    /// the part along the normal does not count. Beyond the Coulomb cap it slides back in the next step. Between two grains the
    /// displacement is that of the first. Springs are read from [`Contact`](crate::Contact).
    ///
    /// # Errors
    /// When the bodies do not touch, the law remembers no spring, or the wall is one of many parts.
    pub fn set_tangential_displacement(
        &mut self,
        id: u32,
        body: OtherBody<'_>,
        displacement: D::Vec,
    ) -> Result<(), SetupError> {
        let first = self.index_of(id)?;
        expect(displacement.is_finite(), "tangential displacement", id, f64::NAN, "finite")?;
        let (partner, normal) = self.contact_with(first, body)?;
        let spring = D::cross(normal, displacement);
        let mut found = false;
        self.change(|dem| {
            let seen = view_of(&dem.grains, (&dem.walls, &dem.moving_walls), &dem.options, dem.last_dt);
            let view = View { cell: dem.cell.as_deref(), ..seen };
            found = dem.pairs.set_spring(&view, first, partner, spring);
        });
        expect(
            found,
            "spring of a contact",
            id,
            f64::NAN,
            "that of a law with friction at a wall of one part or a grain",
        )
    }

    /// The body as contacts know it, and the normal from it to the grain.
    fn contact_with(&self, first: usize, body: OtherBody<'_>) -> Result<(Partner, D::Vec), SetupError> {
        let partner =
            match body {
                OtherBody::Grain(id) => Partner::Grain(self.index_of(id)?),
                OtherBody::Wall(name) => {
                    let found = self.walls.iter().position(|wall| wall.name == name);
                    Partner::Wall(found.ok_or_else(|| {
                        SetupError::new(format!("wall `{name}`"), f64::NAN, "one of the scene")
                    })?)
                }
            };
        let mut normal = None;
        self.visit_contacts(&mut |contact| {
            let same = (contact.first, contact.partner) == (first, partner);
            let swapped =
                partner == Partner::Grain(contact.first) && contact.partner == Partner::Grain(first);
            if same || swapped {
                normal = Some(if same { contact.normal } else { -contact.normal });
            }
        });
        let id = self.grains.id[first];
        let normal = normal
            .ok_or_else(|| SetupError::new(format!("contacts of grain {id} with that body"), 0.0, "one"))?;
        Ok((partner, normal))
    }

    /// Whether a grain is held in its place.
    ///
    /// # Panics
    /// When there is no such grain.
    pub fn is_fixed(&self, id: u32) -> bool {
        self.is_fixed_at(self.index_of(id).expect("the identifier is that of a grain"))
    }

    fn is_fixed_at(&self, index: usize) -> bool {
        self.grains.fixed.get(index).copied().unwrap_or(false)
    }

    /// Mass of a grain \[kg; kg/m in the plane\].
    ///
    /// # Panics
    /// When there is no such grain.
    pub fn mass_of(&self, id: u32) -> f64 {
        self.grains.mass[self.index_of(id).expect("the identifier is that of a grain")]
    }

    /// Moment of inertia of a grain \[kg m^2; kg m in the plane\].
    ///
    /// # Panics
    /// When there is no such grain.
    pub fn inertia_of(&self, id: u32) -> f64 {
        self.grains.inertia_of(self.index_of(id).expect("the identifier is that of a grain"))
    }
}

fn expect(fits: bool, what: &str, id: u32, value: f64, allowed: &'static str) -> Result<(), SetupError> {
    if fits { Ok(()) } else { Err(SetupError::new(what, value, allowed).of(format_args!("grain {id}"))) }
}
