//! Integration tests of the discrete element method.

mod impact;
