//! Tests of what the outside sees.

mod units_page;
