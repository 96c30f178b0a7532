//! Frames of a run over time, as the page holds them.

use crate::arrays::{Arrays, in_base64};
use crate::folder::Run;
use crate::frame::{Frame, Kind, PLACE, kinds};
use crate::quantise::{Bits, Quantiser, is_kept};
use granular_io::Collection;
use serde_json::{Value, json};
use std::io;
use std::path::{Component, Path, PathBuf};

/// A collection of which one kind of thing is shown.
#[derive(Clone, Debug)]
pub(crate) struct Movie {
    /// Name of the collection, without its ending.
    name: String,
    kind: Kind,
    files: Vec<(f64, PathBuf)>,
    /// Numbers of points or cells of all frames.
    counts: Vec<usize>,
    spans: Vec<Span>,
}

/// Values of a channel in all frames.
#[derive(Clone, Debug)]
struct Span {
    field: String,
    component: &'static str,
    unit: String,
    low: f64,
    high: f64,
    /// Whether the values of a frame are those of the one before, always.
    constant: bool,
    last: Vec<f64>,
}

/// How much of the frames a page holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Plan {
    /// Bits of fields; places have sixteen.
    pub(crate) bits: Bits,
    /// Every how manyth frame is taken.
    pub(crate) every: usize,
}

impl Plan {
    /// As exact, then as many frames, as fit.
    pub(crate) fn for_size(movies: &[Movie], largest: u64) -> Self {
        let total = |bits| movies.iter().map(|movie| movie.bytes(bits)).sum::<u64>();
        if total(Bits::Sixteen) <= largest {
            return Self { bits: Bits::Sixteen, every: 1 };
        }
        let every = total(Bits::Eight).div_ceil(largest.max(1));
        Self { bits: Bits::Eight, every: usize::try_from(every).unwrap_or(usize::MAX).max(1) }
    }
}

/// Looks through the collections of a run.
pub(crate) fn movies_of(run: &Run, lacks: &mut Vec<String>) -> Vec<Movie> {
    let mut movies = Vec::new();
    for name in run.files_with(".pvd") {
        match movies_in(run, name, lacks) {
            Ok(found) => movies.extend(found),
            Err(reason) => lacks.push(format!("The frames of {name} are left out: {reason}.")),
        }
    }
    if movies.is_empty() {
        lacks.push("The folder holds no fields over time (.pvd), so there is no animation.".to_owned());
    }
    movies
}

fn movies_in(run: &Run, name: &str, lacks: &mut Vec<String>) -> Result<Vec<Movie>, String> {
    let path = run.path.join(name);
    let collection = Collection::open(&path).map_err(|error| error.reason)?;
    let folder = path.parent().unwrap_or(&run.path);
    let mut files = Vec::new();
    for (time, file) in collection.entries() {
        if !Path::new(file).components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir))
        {
            return Err(format!("it lists `{file}`, which is not in its folder"));
        }
        files.push((*time, folder.join(file)));
    }
    let Some((_, first)) = files.first() else { return Err("it lists no file".to_owned()) };
    let kinds = kinds(first)?;
    if kinds.is_empty() {
        lacks.push(format!("Contacts ({name}) are not animated; ParaView draws them."));
    }
    let stem = name.trim_end_matches(".pvd").to_owned();
    kinds.into_iter().map(|kind| Movie::scan(stem.clone(), kind, files.clone())).collect()
}

fn in_file(path: &Path, reason: &str) -> String {
    format!("{}: {reason}", path.file_name().unwrap_or_default().to_string_lossy())
}

impl Movie {
    /// Reads all frames once.
    fn scan(name: String, kind: Kind, files: Vec<(f64, PathBuf)>) -> Result<Self, String> {
        let mut movie = Self { name, kind, files, counts: Vec::new(), spans: Vec::new() };
        for index in 0..movie.files.len() {
            let frame = movie.frame(index)?;
            movie.counts.push(frame.count);
            movie.widen(frame, index == 0).map_err(|reason| in_file(&movie.files[index].1, &reason))?;
        }
        movie.spans.iter_mut().for_each(|span| span.last = Vec::new());
        // Vectors of the plane have no z, and its tensors no xz and yz. A scalar stays.
        movie.spans.retain(|span| {
            span.component.is_empty() || span.low != 0.0 || span.high != 0.0 || span.is_place_in_plane()
        });
        movie
            .spans
            .iter_mut()
            .filter(|span| span.low > span.high)
            .for_each(|span| (span.low, span.high) = (0.0, 0.0));
        Ok(movie)
    }

    fn frame(&self, index: usize) -> Result<Frame, String> {
        let path = &self.files[index].1;
        Frame::read(path, self.kind).map_err(|reason| in_file(path, &reason))
    }

    /// Takes the values of one more frame in.
    fn widen(&mut self, frame: Frame, first: bool) -> Result<(), String> {
        if first {
            self.spans = frame
                .channels
                .iter()
                .map(|channel| Span {
                    field: channel.field.clone(),
                    component: channel.component,
                    unit: channel.unit.clone(),
                    low: f64::INFINITY,
                    high: f64::NEG_INFINITY,
                    constant: true,
                    last: channel.values.clone(),
                })
                .collect();
        }
        let same =
            self.spans.len() == frame.channels.len()
                && self.spans.iter().zip(&frame.channels).all(|(span, channel)| {
                    span.field == channel.field && span.component == channel.component
                });
        if !same {
            return Err("it has other fields than the first frame".to_owned());
        }
        for (span, channel) in self.spans.iter_mut().zip(frame.channels) {
            for value in channel.values.iter().copied().filter(|value| is_kept(*value)) {
                span.low = span.low.min(value);
                span.high = span.high.max(value);
            }
            if span.constant {
                let same = |(a, b): (&f64, &f64)| a.to_bits() == b.to_bits();
                span.constant = span.last.len() == channel.values.len()
                    && span.last.iter().zip(&channel.values).all(same);
                span.last = channel.values;
            }
        }
        Ok(())
    }

    /// Bytes of all frames in a page.
    fn bytes(&self, bits: Bits) -> u64 {
        let numbers = |span: &Span| {
            let counts = self.counts.iter().take(if span.constant { 1 } else { usize::MAX });
            counts.map(|count| in_base64(*count as u64 * span.bits(bits).bytes())).sum::<u64>()
        };
        self.spans.iter().map(numbers).sum()
    }

    /// Frames that are taken: the first, every so manyth, and the last.
    fn taken(&self, every: usize) -> Vec<usize> {
        let last = self.files.len() - 1;
        let mut taken: Vec<usize> = (0..=last).step_by(every).collect();
        if taken.last() != Some(&last) {
            // The last takes the place of one that is close to it, so that no more than planned are taken.
            if taken.len() > 1 {
                taken.pop();
            }
            taken.push(last);
        }
        taken
    }

    /// Writes the frames and says how to read them.
    pub(crate) fn write(&self, plan: Plan, arrays: &mut Arrays<'_>) -> io::Result<Value> {
        let quantisers: Vec<Quantiser> =
            self.spans.iter().map(|span| Quantiser::new(span.low, span.high, span.bits(plan.bits))).collect();
        let mut numbers: Vec<Vec<usize>> = vec![Vec::new(); self.spans.len()];
        let taken = self.taken(plan.every);
        let mut geometry = Frame::default();
        for &index in &taken {
            let frame = self.frame(index).map_err(io::Error::other)?;
            for ((span, quantiser), numbers) in self.spans.iter().zip(&quantisers).zip(&mut numbers) {
                let known = numbers.last().copied().filter(|_| span.constant);
                let is_own = |channel: &&crate::frame::Channel| {
                    channel.field == span.field && channel.component == span.component
                };
                let values = frame.channels.iter().find(is_own).map_or(&[][..], |channel| &channel.values);
                numbers.push(match known {
                    Some(number) => number,
                    None => arrays.push(&quantiser.bytes(values.iter().copied()))?,
                });
            }
            geometry = Frame { channels: Vec::new(), ..frame };
        }
        let channels = self.spans.iter().zip(&quantisers).zip(numbers);
        let channels = channels.map(|((span, quantiser), numbers)| span.described(quantiser, &numbers));
        let plane = match self.kind {
            Kind::Points => Value::Null,
            Kind::Plane { normal } => json!({ "cells": geometry.cells, "corners": geometry.corners,
                "normal": normal, "cut": geometry.cut, "in_space": self.is_in_space() }),
        };
        Ok(json!({
            "name": self.name,
            "times": taken.iter().map(|&index| self.files[index].0).collect::<Vec<_>>(),
            "counts": taken.iter().map(|&index| self.counts[index]).collect::<Vec<_>>(),
            "frames": self.files.len(),
            "plane": plane,
            "channels": channels.collect::<Vec<_>>(),
        }))
    }

    fn is_in_space(&self) -> bool {
        matches!(self.kind, Kind::Plane { .. }) && kinds(&self.files[0].1).is_ok_and(|kinds| kinds.len() > 1)
    }
}

impl Span {
    /// Places and sizes are seen, so they keep sixteen bits.
    fn bits(&self, wanted: Bits) -> Bits {
        if self.field == PLACE || self.field == "radius" { Bits::Sixteen } else { wanted }
    }

    /// All points may lie on an axis.
    fn is_place_in_plane(&self) -> bool {
        self.field == PLACE && self.component != "z"
    }

    fn described(&self, quantiser: &Quantiser, numbers: &[usize]) -> Value {
        let place = self.field == PLACE;
        json!({
            "field": if place { "" } else { self.field.as_str() },
            "place": place,
            "component": self.component,
            "unit": self.unit,
            "low": quantiser.low,
            "step": quantiser.step,
            "bytes": quantiser.bits.bytes(),
            "error": 0.5 * quantiser.step,
            "arrays": numbers,
        })
    }
}
