//! Disks by place: square buckets that grow upwards, each a linked list through one array.

const END: u32 = u32::MAX;

/// A disk that is met, as the original or a periodic image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Member {
    pub(super) index: u32,
    /// Widths of the box by which the image is moved along x.
    pub(super) image: i64,
}

pub(super) struct Buckets {
    columns: usize,
    column_width: f64,
    row_height: f64,
    periodic: bool,
    /// First disk of each bucket, row upon row.
    heads: Vec<u32>,
    /// The disk that follows each disk in its bucket.
    next: Vec<u32>,
    /// Rows that hold a disk, for each column.
    rows: Vec<usize>,
}

impl Buckets {
    /// Buckets at least `edge` \[m\] wide and `edge` high, for `count` disks.
    pub(super) fn new(count: usize, width: f64, edge: f64, periodic: bool) -> Self {
        // A wide box with few disks needs no more columns than it has disks.
        let columns = (width / edge).floor().clamp(1.0, (2 * count + 16) as f64) as usize;
        Self {
            columns,
            column_width: width / columns as f64,
            row_height: edge,
            periodic,
            heads: Vec::new(),
            next: Vec::with_capacity(count),
            rows: vec![0; columns],
        }
    }

    /// Number of the column at `x`; beyond the box where x is.
    pub(super) fn column(&self, x: f64) -> i64 {
        (x / self.column_width).floor() as i64
    }

    /// Number of the row at `y` above the floor.
    pub(super) fn row(&self, y: f64) -> usize {
        (y / self.row_height) as usize
    }

    /// Height of the top of a row \[m\].
    pub(super) fn top(&self, row: usize) -> f64 {
        (row + 1) as f64 * self.row_height
    }

    /// Adds the next disk, whose `x` lies in the box.
    pub(super) fn add(&mut self, x: f64, y: f64) {
        let column = (self.column(x).max(0) as usize).min(self.columns - 1);
        let row = self.row(y);
        let bucket = row * self.columns + column;
        if bucket >= self.heads.len() {
            self.heads.resize((row + 1) * self.columns, END);
        }
        self.rows[column] = self.rows[column].max(row + 1);
        let index = self.next.len() as u32;
        self.next.push(std::mem::replace(&mut self.heads[bucket], index));
    }

    /// The column inside the box that a column stands for, and the image it belongs to.
    fn inside(&self, column: i64) -> Option<(usize, i64)> {
        let columns = self.columns as i64;
        if self.periodic {
            Some((column.rem_euclid(columns) as usize, column.div_euclid(columns)))
        } else {
            (0..columns).contains(&column).then_some((column as usize, 0))
        }
    }

    /// Rows that hold a disk in the columns `first` to `last`.
    pub(super) fn rows_in(&self, first: i64, last: i64) -> usize {
        (first..=last)
            .filter_map(|column| self.inside(column))
            .map(|(column, _)| self.rows[column])
            .max()
            .unwrap_or(0)
    }

    /// Calls `visit` for the disks of one row in the columns `first` to `last`, in an order that
    /// depends on what was added only.
    pub(super) fn visit_row(&self, row: usize, first: i64, last: i64, visit: &mut impl FnMut(Member)) {
        for column in first..=last {
            let Some((column, image)) = self.inside(column) else {
                continue;
            };
            if row >= self.rows[column] {
                continue;
            }
            let mut index = self.heads[row * self.columns + column];
            while index != END {
                visit(Member { index, image });
                index = self.next[index as usize];
            }
        }
    }

    /// Calls `visit` for all disks whose centre may lie between two corners.
    pub(super) fn visit_box(&self, low: [f64; 2], high: [f64; 2], visit: &mut impl FnMut(Member)) {
        let (first, last) = (self.column(low[0]), self.column(high[0]));
        let rows = self.rows_in(first, last).min(self.row(high[1]) + 1);
        for row in self.row(low[1])..rows {
            self.visit_row(row, first, last, visit);
        }
    }
}
