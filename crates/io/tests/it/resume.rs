//! A run that is taken up again ends with the same files as one in one go.

use crate::folder;
use granular_core::glam::DVec2;
use granular_core::{FieldRef, FieldSink, Location, Section};
use granular_io::{Collection, Frame, SnapshotStore, TableWriter, read_table, write_fields};
use std::path::Path;

const COLUMNS: [(&str, &str); 2] = [("time", "s"), ("height", "m")];

/// A ball that falls; all state is in `step`.
struct Run {
    table: TableWriter,
    list: Collection,
    store: SnapshotStore,
    step: u64,
}

impl Run {
    fn begin(folder: &Path) -> Self {
        let table = TableWriter::create(&folder.join("series.csv"), &COLUMNS).unwrap();
        let list = Collection::create(&folder.join("fields.pvd")).unwrap();
        Self { table, list, store: SnapshotStore::new(folder), step: 0 }
    }

    fn resume(folder: &Path) -> Self {
        let store = SnapshotStore::new(folder);
        let latest = store.latest().unwrap();
        let [bytes, files] = latest.sections[0].one("outputs").unwrap();
        let table = TableWriter::reopen_at(&folder.join("series.csv"), &COLUMNS, bytes).unwrap();
        let list = Collection::reopen_at(&folder.join("fields.pvd"), files as usize).unwrap();
        Self { table, list, store, step: latest.step }
    }

    fn advance(&mut self, folder: &Path) {
        let time = 0.1 * self.step as f64;
        let height = 1.0 - 4.905 * time * time;
        self.table.row(&[time, height]).unwrap();
        let mut frame = Frame::wanting(["height"]);
        frame.number("height", "m", height);
        let stem = format!("fields-{}", self.step);
        let points = [DVec2::new(0.0, height)];
        let location = Location::Points(FieldRef::Vector2(&points));
        let file = write_fields(folder, &stem, &location, &frame, time).unwrap();
        self.list.push(time, file.file_name().unwrap().to_str().unwrap()).unwrap();
        self.step += 1;
    }

    fn save(&self) {
        let mut state = Section::new("outputs");
        state.put_one("outputs", [self.table.position(), self.list.len() as u64]);
        self.store.save(self.step, &[state]).unwrap();
    }
}

#[test]
fn a_resumed_run_has_the_same_files() {
    let (straight, resumed) = (folder("straight"), folder("resumed"));
    let mut run = Run::begin(&straight);
    (0..6).for_each(|_| run.advance(&straight));
    let mut run = Run::begin(&resumed);
    (0..2).for_each(|_| run.advance(&resumed));
    run.save();
    // These three are lost with the process.
    (0..3).for_each(|_| run.advance(&resumed));
    drop(run);
    let mut run = Run::resume(&resumed);
    assert_eq!(run.step, 2);
    (0..4).for_each(|_| run.advance(&resumed));
    for name in ["series.csv", "fields.pvd", "fields-5.vtp"] {
        let read = |folder: &Path| std::fs::read(folder.join(name)).unwrap();
        assert_eq!(read(&straight), read(&resumed), "{name}");
    }
    assert_eq!(read_table(&resumed.join("series.csv")).unwrap().column("time").unwrap().len(), 6);
}
