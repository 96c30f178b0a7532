//! How much of a study is run.

/// How much is run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Effort {
    /// Small samples, at most about ten seconds a case.
    #[default]
    Quick,
    /// Everything.
    Full,
}
