//! Where a run stops finishing: a ladder towards the hostile end, then bisection.

use super::watch::End;

/// Where a sweep goes.
#[derive(Clone, Debug)]
pub(crate) struct Range {
    /// Values from the mild to the hostile end, tried in turn until one does not finish.
    pub(crate) rungs: Vec<f64>,
    /// Bisection ends when two values are nearer than this factor.
    pub(crate) factor: f64,
}

/// What a sweep found.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Found {
    /// The most hostile value that finished; none when the first one did not.
    pub(crate) finished: Option<f64>,
    /// The mildest value that did not finish, and how it ended; none when all did.
    pub(crate) failed: Option<(f64, String)>,
    /// Runs in which the guard was silent: value and what happened.
    pub(crate) missed: Vec<(f64, String)>,
}

impl Range {
    /// Steps of equal ratio between two values, at most `ratio` (above 1), with one more rung where it lies between.
    pub(crate) fn new([from, to]: [f64; 2], ratio: f64, between: Option<f64>, factor: f64) -> Self {
        let count = ((to / from).ln().abs() / ratio.ln()).ceil().max(1.0);
        let mut rungs: Vec<f64> =
            (0..=count as u32).map(|k| from * (to / from).powf(f64::from(k) / count)).collect();
        let last = rungs.len() - 1;
        rungs[last] = to;
        let within = |value: &f64| (value - from) * (value - to) < 0.0;
        rungs.extend(between.filter(within));
        rungs.sort_by(f64::total_cmp);
        if to < from {
            rungs.reverse();
        }
        Self { rungs, factor }
    }

    /// Tries values. That a value finishes says nothing of the milder ones beyond the rungs that were tried.
    pub(crate) fn search(&self, mut run: impl FnMut(f64) -> End) -> Found {
        let mut found = Found { finished: None, failed: None, missed: Vec::new() };
        for &value in &self.rungs {
            if found.take(value, run(value)) {
                break;
            }
        }
        while let (Some(finished), Some((failed, _))) = (found.finished, &found.failed)
            && (failed / finished).ln().abs() > self.factor.ln()
        {
            let middle = (finished * failed).sqrt();
            found.take(middle, run(middle));
        }
        found
    }
}

impl Found {
    /// Notes how a run ended; whether it did not finish.
    fn take(&mut self, value: f64, end: End) -> bool {
        match end {
            End::Finished => {
                self.finished = Some(value);
                return false;
            }
            End::Stopped(why) => self.failed = Some((value, why)),
            End::Missed(why) => {
                self.missed.push((value, why.clone()));
                self.failed = Some((value, why));
            }
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stops_above(limit: f64) -> impl FnMut(f64) -> End {
        move |value| if value <= limit { End::Finished } else { End::Stopped(format!("{value}")) }
    }

    #[test]
    fn bisection_closes_in_on_the_limit_from_both_sides() {
        let range = Range::new([1.0, 1000.0], 2.0, Some(50.0), 1.01);
        assert!(range.rungs.contains(&50.0) && range.rungs.is_sorted());
        assert_eq!((range.rungs[0], range.rungs[range.rungs.len() - 1]), (1.0, 1000.0));
        let found = range.search(stops_above(37.0));
        let (below, (above, _)) = (found.finished.unwrap(), found.failed.unwrap());
        assert!(below <= 37.0 && 37.0 < above && above / below <= 1.01, "{below} {above}");
        assert!(found.missed.is_empty());
    }

    #[test]
    fn it_goes_down_as_well_as_up() {
        let range = Range::new([0.5, 1e-4], 3.0, None, 1.05);
        let found = range.search(|v| if v >= 0.003 { End::Finished } else { End::Stopped(String::new()) });
        let (inside, (outside, _)) = (found.finished.unwrap(), found.failed.unwrap());
        assert!(outside < 0.003 && 0.003 <= inside && inside / outside <= 1.05, "{inside} {outside}");
    }

    #[test]
    fn a_range_without_a_limit_and_one_that_fails_at_once_are_told() {
        let range = Range::new([1.0, 8.0], 2.0, None, 1.1);
        let all = range.search(stops_above(100.0));
        assert_eq!((all.finished, all.failed), (Some(8.0), None));
        let none = range.search(stops_above(0.5));
        assert_eq!((none.finished, none.failed.unwrap().0), (None, 1.0));
    }

    #[test]
    fn silent_guards_are_kept() {
        let range = Range::new([1.0, 8.0], 2.0, None, 1.5);
        let found = range.search(|v| if v < 3.0 { End::Finished } else { End::Missed("silent".to_owned()) });
        assert!(!found.missed.is_empty() && found.failed.unwrap().1 == "silent");
    }
}
