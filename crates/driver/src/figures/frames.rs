//! Which frames of an output a figure shows.

use super::Units;
use crate::failure::Failure;
use crate::folder::RunFolder;
use granular_io::Collection;
use std::path::{Path, PathBuf};

/// Frames of an output at the times of a figure.
#[derive(Debug)]
pub(super) struct Frames {
    /// Their files, in the order of the times.
    pub(super) files: Vec<PathBuf>,
    /// What is to be said of times without a frame of their own.
    pub(super) left_out: Option<String>,
}

/// What is shown for a time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Choice {
    /// The frame of this number.
    Frame(usize),
    /// The last frame, of this number, though the run ended before the time.
    Last(usize),
    /// Nothing: the run ended before, and its last frame is shown already.
    Beyond,
    /// Nothing: its nearest frame stands for another time already.
    Again,
}

impl Choice {
    /// The number of the frame that is shown.
    pub(super) fn frame(self) -> Option<usize> {
        match self {
            Self::Frame(number) | Self::Last(number) => Some(number),
            Self::Beyond | Self::Again => None,
        }
    }
}

impl Frames {
    /// The frames of an output nearest to times in the units of a figure.
    pub(super) fn of(folder: &RunFolder, output: &str, times: &[f64], units: Units) -> Result<Self, Failure> {
        let list = folder.path().join(format!("{output}.pvd"));
        let collection = Collection::open(&list)?;
        let available: Vec<f64> = collection.entries().iter().map(|(time, _)| *time).collect();
        if available.is_empty() {
            return Err(Failure::io(list.display(), "lists no files yet"));
        }
        let choices = choose(&available, times, units);
        let left_out = left_out(&choices, (&available, output), times, units);
        let parent = list.parent().unwrap_or(Path::new("."));
        let file = |number: usize| parent.join(&collection.entries()[number].1);
        let files = choices.iter().filter_map(|choice| choice.frame()).map(file).collect();
        Ok(Self { files, left_out })
    }
}

/// For each time in the units of a figure, which of the simulated times in `available` \[s\], which rise, stands for it:
/// the nearest one, and for time 0 the last one before the stage began, since afterwards things move. The state at the end
/// stands for one later time at most.
pub(super) fn choose(available: &[f64], times: &[f64], units: Units) -> Vec<Choice> {
    let [before, last] = match *available {
        [] => return vec![Choice::Beyond; times.len()],
        [only] => [only, only],
        [.., before, last] => [before, last],
    };
    // A run may end up to an interval after its last frame.
    let end = last + (last - before) * (1.0 + 1e-9) + 1e-12 * last.abs();
    let mut taken = vec![false; available.len()];
    let mut one = |&time: &f64| {
        let wanted = units.start + time * units.time;
        if wanted > end {
            let last = available.len() - 1;
            return if std::mem::replace(&mut taken[last], true) {
                Choice::Beyond
            } else {
                Choice::Last(last)
            };
        }
        let after = available.partition_point(|frame| *frame <= wanted);
        let earlier = after.saturating_sub(1);
        let later = after.min(available.len() - 1);
        let nearer_later = available[later] - wanted < wanted - available[earlier];
        let number = if after == 0 || (time > 0.0 && nearer_later) { later } else { earlier };
        if std::mem::replace(&mut taken[number], true) { Choice::Again } else { Choice::Frame(number) }
    };
    times.iter().map(&mut one).collect()
}

/// What is to be said of times for which nothing is shown.
pub(super) fn left_out(
    choices: &[Choice],
    (available, output): (&[f64], &str),
    times: &[f64],
    units: Units,
) -> Option<String> {
    let of = |is: fn(&Choice) -> bool| {
        let all = choices.iter().zip(times).filter(|(choice, _)| is(choice));
        all.map(|(_, time)| units.name_of(*time)).collect::<Vec<_>>()
    };
    let late = of(|choice| matches!(choice, Choice::Last(_)));
    let beyond = of(|choice| *choice == Choice::Beyond);
    let again = of(|choice| *choice == Choice::Again);
    let mut parts = Vec::new();
    let last = available.last().map_or_else(String::new, |last| units.label(*last));
    if !late.is_empty() {
        parts.push(format!("the last state is shown for {}: `{output}` ends at {last}", late.join(", ")));
    }
    if !beyond.is_empty() {
        parts.push(format!("nothing is shown for {}: `{output}` ends at {last}", beyond.join(", ")));
    }
    if !again.is_empty() {
        parts.push(format!(
            "nothing is shown for {}: the nearest time in `{output}` is shown already; write it more often",
            again.join(", ")
        ));
    }
    (!parts.is_empty()).then(|| parts.join("; "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use Choice::{Again, Beyond, Frame, Last};

    #[test]
    fn a_time_beyond_the_end_has_no_frame_and_no_frame_is_shown_twice() {
        let units = Units { start: 1.0, time: 0.5, scaled: true };
        // Frames at -0.8, 0.2, 1.2 and 2.2 units after the start of the stage.
        let available = [0.6, 1.1, 1.6, 2.1];
        let times = [0.0, 1.0, 1.4, 2.0, 3.0, 3.3, 9.0];
        let found = choose(&available, &times, units);
        // 3 lies within an interval of the last frame, which may be where the run ended.
        assert_eq!(found, [Frame(0), Frame(2), Again, Frame(3), Again, Beyond, Beyond]);
        let said = left_out(&found, (&available, "grains"), &times, units).unwrap();
        assert!(said.contains("t = 3.3 √(H₀/g), t = 9 √(H₀/g): `grains` ends at t = 2.2 √(H₀/g)"), "{said}");
        assert!(said.contains("t = 1.4 √(H₀/g), t = 3 √(H₀/g): the nearest"), "{said}");
        assert_eq!(left_out(&found[..2], (&available, "grains"), &times[..2], units), None);
        // Of a flow that became steady early the last state is shown once, and it is said.
        let found = choose(&available, &[0.0, 50.0, 60.0], units);
        assert_eq!(found, [Frame(0), Last(3), Beyond]);
        let said = left_out(&found, (&available, "grains"), &[0.0, 50.0, 60.0], units).unwrap();
        assert!(
            said.contains("the last state is shown for t = 50 √(H₀/g): `grains` ends at t = 2.2"),
            "{said}"
        );
    }

    #[test]
    fn the_state_at_the_start_of_a_stage_is_the_one_before_things_move() {
        let units = Units { start: 1.0, time: 1.0, scaled: false };
        assert_eq!(choose(&[0.0, 0.5, 1.01, 1.5], &[0.0, 0.01], units), [Frame(1), Frame(2)]);
        assert_eq!(choose(&[0.0, 1.0, 2.0], &[0.0], units), [Frame(1)]);
        // Nothing was written before.
        assert_eq!(choose(&[1.2, 1.4], &[0.0, 0.2], units), [Frame(0), Again]);
        assert_eq!(choose(&[1.0], &[0.0, 1.0], units), [Frame(0), Beyond]);
        assert_eq!(choose(&[1.0], &[5.0], units), [Last(0)]);
        assert_eq!(choose(&[], &[0.0], units), [Beyond]);
        assert_eq!((units.label(1.0), units.label(0.97)), ("t = 0 s".to_owned(), "t = -0.03 s".to_owned()));
    }
}
