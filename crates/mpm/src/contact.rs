//! Frictional contact of bodies: each has velocities of its own on the nodes that it shares with others, and where two approach,
//! they exchange momentum \[Bardenhagen2000\], \[Bardenhagen2001\].
//!
//! Bodies that are in no contact share one set of nodal sums, as if there were no contact at all. Every other body is given a set, a
//! *field*. Nodes are laid out block by block, and in a block field by field.
//!
//! Bodies are in contact at a node once the ends of both, as the node sees them, have met: without this they would be as soon as they share a
//! node, a cell or more apart.
//!
//! The normal of a pair is common to both, so momentum is kept to round-off: the mean of the gradients of their volumes at the node, in
//! which a flat side counts far more than a corner does \[Lemiale2010\].

mod exchange;
mod parties;
mod surface;

use exchange::{Chunks, Rules};
pub(crate) use exchange::{Exchanged, Pair};
use parties::ContactRule;
use surface::Surfaces;

use crate::layout::{Node, block_cells};
use crate::mpm::{BodyId, Mpm};
use crate::particles::Cut;
use crate::step::{Answer, NodeRule};
use granular_core::snapshot::check_entry;
use granular_core::{Dim, Linear, PerBlock, Section, SetupError, SnapshotError};

/// Most fields: bodies in contact, and one for all others.
pub(crate) const MOST_FIELDS: usize = 16;

/// What two bodies in contact do to one another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Coefficient of friction; zero for none.
    pub friction: f64,
}

/// A contact between two bodies, the one that was added first before the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Declared {
    pub(crate) bodies: [usize; 2],
    pub(crate) friction: f64,
}

/// All contacts; empty, and without cost, where none is declared.
#[derive(Clone, Debug, Default)]
pub(crate) struct Contacts<D: Dim> {
    pub(crate) declared: Vec<Declared>,
    rules: Rules,
    /// Made when the first contact is declared.
    surfaces: Option<Surfaces>,
    /// Where each field ends near each node, laid out like the sums: gradient and moment of its volume, and the volume.
    outlines: Vec<Node>,
    /// What was exchanged on each block, contact by contact, and last by what sticks.
    exchanged: Vec<Exchanged<D>>,
    /// Force on the second body of each contact in the last step \[N\].
    forces: Vec<D::Vec>,
}

impl<D: Dim> Contacts<D> {
    pub(crate) fn is_empty(&self) -> bool {
        self.declared.is_empty()
    }

    pub(crate) fn bytes(&self) -> usize {
        size_of_val(&self.outlines[..]) + size_of_val(&self.exchanged[..])
    }

    pub(crate) fn save(&self, to: &mut Section) {
        if !self.is_empty() {
            to.put("forces of contacts", &self.forces);
        }
    }

    pub(crate) fn restore(&mut self, from: &Section) -> Result<(), SnapshotError> {
        if self.is_empty() {
            return Ok(());
        }
        self.forces = from.array_of("forces of contacts", self.declared.len())?;
        check_entry("forces of contacts", self.forces.iter().all(|force| force.is_finite()))
    }
}

impl<D: Dim> Mpm<D> {
    /// Declares two bodies to be in contact: they may part and slide along one another. Two bodies that are in contact with others, but
    /// not declared to be with one another, stick where they meet, as all bodies do that are in no contact.
    ///
    /// # Errors
    /// When friction is out of range, the bodies are one, the contact is declared already, or more than 15 bodies are in contact.
    pub fn contact(&mut self, one: BodyId, other: BodyId, contact: Contact) -> Result<(), SetupError> {
        let Contact { friction } = contact;
        if !(friction >= 0.0 && friction.is_finite()) {
            return Err(SetupError::new("friction of a contact", friction, "zero or more, and finite"));
        }
        let bodies = [one.0.min(other.0), one.0.max(other.0)];
        if bodies[0] == bodies[1] || bodies[1] >= self.groups.len() {
            return Err(SetupError::new(
                "number of a body in contact",
                bodies[1] as f64,
                "that of another body",
            ));
        }
        if self.contacts.declared.iter().any(|declared| declared.bodies == bodies) {
            let allowed = "a pair of bodies that is not declared yet";
            return Err(SetupError::new("number of a body in contact", bodies[1] as f64, allowed));
        }
        self.contacts.declared.push(Declared { bodies, friction });
        let in_contact = (0..self.groups.len()).filter(|&body| self.is_in_contact(body)).count();
        if in_contact >= MOST_FIELDS {
            self.contacts.declared.pop();
            return Err(SetupError::new("number of bodies in contact", in_contact as f64, "at most 15"));
        }
        self.lay_out_fields();
        Ok(())
    }

    /// Force on the second of two bodies in contact by the first in the last step \[N; N/m in the plane\]; none where they are not
    /// declared to be in contact.
    pub fn contact_force(&self, first: BodyId, second: BodyId) -> Option<D::Vec> {
        let bodies = [first.0.min(second.0), first.0.max(second.0)];
        let place = self.contacts.declared.iter().position(|declared| declared.bodies == bodies)?;
        let force = self.contacts.forces[place];
        Some(if first.0 < second.0 { force } else { -force })
    }

    fn is_in_contact(&self, body: usize) -> bool {
        self.contacts.declared.iter().any(|declared| declared.bodies.contains(&body))
    }

    /// Gives each body in contact a field, and one to all others.
    pub(crate) fn lay_out_fields(&mut self) {
        let in_contact: Vec<bool> = (0..self.groups.len()).map(|body| self.is_in_contact(body)).collect();
        let mut fields = usize::from(in_contact.contains(&false));
        for (group, in_contact) in self.groups.iter_mut().zip(in_contact) {
            group.field = if in_contact { fields } else { 0 };
            fields += usize::from(in_contact);
        }
        let Self { contacts, groups, .. } = self;
        let pairs = contacts.declared.iter().map(|&Declared { bodies, friction }| Pair {
            fields: bodies.map(|body| groups[body].field),
            friction,
        });
        contacts.rules = Rules::new(pairs.collect());
        contacts.surfaces.get_or_insert_with(|| Surfaces::of(self.options.shape));
        contacts.forces = vec![D::Vec::ZERO; contacts.declared.len()];
        self.grid.set_fields(fields.max(1));
    }

    /// Particles give to the nodes, field by field; with force, also where each field ends.
    pub(crate) fn give_by_field(&mut self, force: bool) {
        for field in 0..self.grid.fields {
            self.fill_tiles(field, force);
            let mut sums = std::mem::take(&mut self.grid.sums);
            self.collect_field(field, &mut sums);
            self.grid.sums = sums;
            if force {
                self.fill_tiles_with_outlines(field);
                let mut outlines = std::mem::take(&mut self.contacts.outlines);
                outlines.resize(self.grid.sums.len(), Node::ZERO);
                self.collect_field(field, &mut outlines);
                self.contacts.outlines = outlines;
            }
        }
    }

    /// Collects what tiles hold of one field.
    fn collect_field(&self, field: usize, to: &mut [Node]) {
        let cells = block_cells::<D>();
        self.grid.node_blocks().for_each(to, |block, nodes| {
            self.grid.collect(block, &self.tiles, &mut nodes[field * cells..(field + 1) * cells]);
        });
    }

    /// Nodes find how they move, field by field, with what they exchange.
    pub(crate) fn answer_by_field(&mut self, rule: &NodeRule<'_, D>, answer: Answer) {
        let Self { grid, touches, damped, contacts, .. } = self;
        let (sums, mut motion) = (std::mem::take(&mut grid.sums), std::mem::take(&mut grid.motion));
        let Some(surfaces) = &contacts.surfaces else { return };
        let blocks = grid.node_blocks();
        let slots = contacts.declared.len() + 1;
        contacts.exchanged.resize(blocks.count() * slots, Exchanged::default());
        let (cells, outlines) = (block_cells::<D>() * grid.fields, &contacts.outlines);
        let touching = Cut::new(&touches.starts, &mut touches.list);
        let exchanged = Chunks { items: &mut contacts.exchanged[..], each: slots };
        let work = (&mut motion[..], touching, PerBlock(&mut damped[..]), exchanged);
        blocks.for_each(work, |block, (motion, touches, damped, exchanged)| {
            let own = block * cells..(block + 1) * cells;
            let mut contact = ContactRule {
                rule,
                rules: &contacts.rules,
                surfaces,
                corner: grid.lattice.in_cells(grid.blocks()[block]),
                fields: grid.fields,
                sums: &sums[own.clone()],
                outlines: &outlines[own],
                motion,
                touches: touches.items,
                exchanged: exchanged.items,
            };
            match answer {
                Answer::Accelerate => damped.0[0] = contact.accelerate(),
                Answer::Velocity(vector, anew) => contact.velocity(vector, anew),
            }
        });
        (grid.sums, grid.motion) = (sums, motion);
    }

    /// Sums what bodies in contact exchanged in a step.
    pub(crate) fn note_contacts(&mut self, dt: f64) {
        let Self { contacts, losses, options, .. } = self;
        let slots = contacts.declared.len() + 1;
        contacts.forces.fill(D::Vec::ZERO);
        for (k, exchanged) in contacts.exchanged.iter().enumerate() {
            if let Some(force) = contacts.forces.get_mut(k % slots) {
                *force += exchanged.impulse * (1.0 / dt);
            }
            if options.ledger {
                losses.contact_friction += exchanged.lost[0];
                losses.contact_stopping += exchanged.lost[1];
            }
        }
    }
}
