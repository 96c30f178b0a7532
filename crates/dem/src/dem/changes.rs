//! Changes between steps, such as those of a stage.

use super::Dem;
use crate::choice::{choose_law, needs_rotation};
use crate::material::{MaterialId, SetupError};
use crate::shaking::{Shaken, Shaking};
use granular_core::{Dim, Linear};

impl<D: Dim> Dem<D> {
    /// Opens or closes the wall of this name. Returns whether there is one.
    pub fn set_open(&mut self, name: &str, open: bool) -> bool {
        let found = self.walls.iter().position(|wall| wall.name == name);
        self.change(|dem| {
            if let Some(index) = found {
                dem.walls[index].open = open;
            }
        });
        found.is_some()
    }

    /// Starts or holds the moving wall of this name, where it is. Returns whether there is one.
    pub fn set_moving(&mut self, name: &str, moves: bool) -> bool {
        let Some(wall) = self.walls.iter().position(|wall| wall.name == name) else { return false };
        let time = self.clock.time();
        let found = self.moving_walls.set_running(wall, moves, time);
        if found {
            self.moving_walls.place(time);
        }
        found
    }

    /// Changes gravity \[m/s^2\].
    pub fn set_gravity(&mut self, gravity: D::Vec) {
        self.change(|dem| dem.gravity = gravity);
    }

    /// Changes the friction of one material. When friction comes into a scene that had none,
    /// grains begin to turn and contacts to remember.
    pub fn set_friction(&mut self, material: MaterialId, friction: f64) {
        self.change(|dem| {
            dem.materials.set_friction(material, friction);
            dem.take_materials(needs_rotation(&dem.materials));
        });
    }

    /// Sets all velocities and spins to zero.
    pub fn stop_motion(&mut self) {
        self.change(|dem| {
            dem.grains.velocity.fill(D::Vec::ZERO);
            dem.grains.spin.fill(D::Spin::ZERO);
        });
    }

    /// Changes something between steps, and books the energy that this puts in.
    pub(crate) fn change(&mut self, change: impl FnOnce(&mut Self)) {
        let before = self.options.ledger.then(|| self.energies().mechanical());
        change(self);
        self.unchecked = true;
        self.list(0.0, None);
        if let Some(before) = before {
            self.injected += self.energies().mechanical() - before;
        }
    }

    /// Takes changed materials; grains begin to turn if they shall. They never stop turning: a
    /// scene may give friction and take it away again.
    pub(crate) fn take_materials(&mut self, turning: bool) {
        if self.custom_law || self.pairs.tangential() || !turning {
            self.pairs.update(&self.materials, self.options.tension);
        } else {
            self.pairs = choose_law::<D>(&self.materials, &self.options, self.blocks, true);
            self.let_turn();
        }
    }
}

impl<D: Dim> Dem<D> {
    /// Starts a shaking, or ends it. In a periodic cell all images are shaken alike: what is at rest relative to the flow
    /// of the cell gains the same velocity.
    ///
    /// # Errors
    /// When a value is out of range.
    pub fn set_shaking(&mut self, shaking: Option<Shaking<D>>) -> Result<(), SetupError> {
        shaking.iter().try_for_each(Shaking::check)?;
        self.shaken = shaking.map(|shaking| Shaken { shaking, age: 0.0 });
        Ok(())
    }

    /// What shakes the grains in the middle of a step of `dt` \[m/s^2\]; the step makes it older.
    pub(crate) fn shake(&mut self, dt: f64) -> Option<D::Vec> {
        let shaken = self.shaken.as_mut()?;
        let acceleration = shaken.shaking.at(shaken.age + 0.5 * dt);
        shaken.age += dt;
        Some(acceleration)
    }
}
