//! Who takes steps within those of whom.

use super::graph::Graph;
use crate::exchange::CouplingError;

/// Solvers that couplings join, directly or through others; a free solver is a group of its own. Groups do not see each
/// other, so each has its own long step.
pub(super) struct Group {
    /// All solvers.
    pub(super) members: Vec<usize>,
    /// Those that are fast to nobody: they take the long step whole.
    pub(super) slow: Vec<usize>,
    /// Those that take their steps within the long one. Others take them within steps of these.
    pub(super) partners: Vec<usize>,
}

impl Group {
    /// Whether it is one free solver.
    pub(super) fn is_alone(&self) -> bool {
        self.members.len() == 1
    }
}

/// The slow solver within whose steps a solver takes its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Holder {
    /// It is fast to nobody.
    None,
    /// Those that take the long step whole.
    LongStep,
    /// One that is fast itself.
    Node(usize),
}

impl Graph {
    fn ends(&self) -> Vec<[usize; 2]> {
        self.edges.iter().map(|edge| edge.ends()).collect()
    }

    /// Whether a law from a slow to a fast solver leaves an order in which all can take their steps.
    pub(super) fn check_order(&self, law: &str, [slow, fast]: [usize; 2]) -> Result<(), CouplingError> {
        if slow == fast {
            return Err(CouplingError::new(law, "both ends are one solver"));
        }
        let mut ends = self.ends();
        if let Some(ring) = path(&ends, fast, slow) {
            let names: Vec<String> = ring.iter().map(|&k| format!("`{}`", self.nodes[k].name)).collect();
            let reason = format!(
                "{} is to be slow to {}, which would close the ring {} - {}: none would be the slowest; leave one of \
                 these couplings out or turn it round",
                names[names.len() - 1],
                names[0],
                names.join(" - "),
                names[0]
            );
            return Err(CouplingError::new(law, reason));
        }
        ends.push([slow, fast]);
        self.holders(&ends).map(|_| ())
    }

    /// Finds the groups, in the order of their first solvers, and who takes steps within those of whom.
    pub(super) fn regroup(&mut self) {
        let ends = self.ends();
        let holders = self.holders(&ends).expect("each coupling was checked before it was added");
        let mut first: Vec<usize> = (0..self.nodes.len()).collect();
        for [a, b] in &ends {
            let (kept, other) = (first[*a].min(first[*b]), first[*a].max(first[*b]));
            first.iter_mut().filter(|group| **group == other).for_each(|group| *group = kept);
        }
        let holders = &holders[..];
        let held_by = |holder: Holder| (0..holders.len()).filter(move |&k| holders[k] == holder);
        for (k, node) in self.nodes.iter_mut().enumerate() {
            node.partners = held_by(Holder::Node(k)).collect();
            let acts_within = self.edges.iter().any(|edge| edge.ends()[1] == k && edge.acts_within());
            node.one_by_one = acts_within || !node.partners.is_empty();
        }
        let group_of = |group: usize| Group {
            members: (0..first.len()).filter(|&k| first[k] == group).collect(),
            slow: held_by(Holder::None).filter(|&k| first[k] == group).collect(),
            partners: held_by(Holder::LongStep).filter(|&k| first[k] == group).collect(),
        };
        self.groups = (0..first.len()).filter(|&k| first[k] == k).map(group_of).collect();
    }

    /// The holder of each solver. A solver with several slow partners takes its steps within those of the one that has the
    /// shortest, so each of the others must hold that one, or take the long step whole.
    fn holders(&self, ends: &[[usize; 2]]) -> Result<Vec<Holder>, CouplingError> {
        let mut depth = vec![0_usize; self.nodes.len()];
        // There is no ring, so that after as many passes as solvers nothing changes any more.
        for _ in 0..self.nodes.len() {
            ends.iter().for_each(|&[slow, fast]| depth[fast] = depth[fast].max(depth[slow] + 1));
        }
        let mut order: Vec<usize> = (0..self.nodes.len()).collect();
        order.sort_by_key(|&k| depth[k]);
        let mut holders = vec![Holder::None; self.nodes.len()];
        for node in order.into_iter().filter(|&k| depth[k] > 0) {
            let partners = || ends.iter().filter(|[_, fast]| *fast == node).map(|[slow, _]| *slow);
            let nearest = partners().max_by_key(|&k| depth[k]).filter(|&k| depth[k] > 0);
            let Some(nearest) = nearest else {
                holders[node] = Holder::LongStep;
                continue;
            };
            holders[node] = Holder::Node(nearest);
            let other = partners().find(|&k| depth[k] > 0 && k != nearest && !holds(&holders, k, nearest));
            if let Some(other) = other {
                let [a, b] = [nearest, other].map(|k| &self.nodes[k].name);
                let reason = format!(
                    "it is fast to `{a}` and to `{b}`, which take steps of their own beside each other, so there is none \
                     within which it could take its own"
                );
                return Err(CouplingError::new(self.nodes[node].name.clone(), reason));
            }
        }
        Ok(holders)
    }
}

/// Whether `inner` takes its steps within those of `outer`.
fn holds(holders: &[Holder], outer: usize, inner: usize) -> bool {
    let next = |&k: &usize| if let Holder::Node(holder) = holders[k] { Some(holder) } else { None };
    std::iter::successors(Some(inner), next).any(|k| k == outer)
}

/// The solvers from one to another, each slow to the next.
fn path(ends: &[[usize; 2]], from: usize, to: usize) -> Option<Vec<usize>> {
    if from == to {
        return Some(vec![to]);
    }
    let mut next = ends.iter().filter(|[slow, _]| *slow == from);
    let rest = next.find_map(|[_, fast]| path(ends, *fast, to))?;
    Some(std::iter::once(from).chain(rest).collect())
}
