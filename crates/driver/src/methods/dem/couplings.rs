//! What laws between solvers show at grains, such as the force of a fluid.

use granular_core::{CouplingView, FieldSink, Shown, Simulation};

/// Laws that act on these grains. Of laws that show the same the first one counts.
fn of<'a>(simulation: &'a Simulation, grains: &str) -> Vec<CouplingView<'a>> {
    let mut found: Vec<CouplingView<'a>> = Vec::new();
    for law in simulation.couplings().filter(|law| law.fast() == grains) {
        let names: Vec<String> = law.shown().into_iter().map(|shown| shown.name).collect();
        let is_new = found.iter().flat_map(CouplingView::shown).all(|shown| !names.contains(&shown.name));
        if is_new {
            found.push(law);
        }
    }
    found
}

pub(super) fn shown(simulation: &Simulation, grains: &str) -> Vec<Shown> {
    of(simulation, grains).iter().flat_map(CouplingView::shown).collect()
}

pub(super) fn show(simulation: &Simulation, grains: &str, sink: &mut dyn FieldSink) {
    of(simulation, grains).iter().for_each(|law| law.show(sink));
}
