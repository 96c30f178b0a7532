//! Pages of small run folders that are made here.

#![allow(clippy::unwrap_used, reason = "helpers of tests may fail like tests")]

mod folders;
mod movies;
mod pages;
mod support;
