//! A process that dies, or is refused space, in the middle of writing a snapshot.

use crate::{folder, names};
use granular_core::Section;
use granular_io::SnapshotStore;
use std::path::Path;
use std::process::{Command, ExitStatus};

const VARIABLE: &str = "GRANULAR_IO_WRITE_INTO";

fn state(values: usize) -> Section {
    let mut state = Section::new("grains");
    state.put("position", &vec![1.5; values]);
    state
}

/// Not a test of its own: the tests below run it in a process of its own with a limit on the
/// size of files.
#[test]
fn child_that_writes_a_large_snapshot() {
    let Some(folder) = std::env::var_os(VARIABLE) else { return };
    let error = SnapshotStore::new(folder).save(2, &[state(1 << 20)]).unwrap_err();
    assert!(error.to_string().contains("snapshot-000000000002.bin"), "{error}");
}

/// Runs the child after `before`, a shell command.
fn write_with_limit(folder: &Path, before: &str) -> ExitStatus {
    let script = format!(
        "{before} ulimit -c 0; ulimit -f 256; exec \"$0\" --exact kill::child_that_writes_a_large_snapshot"
    );
    let program = std::env::current_exe().unwrap();
    let mut shell = Command::new("sh");
    shell.arg("-c").arg(script).arg(program).env(VARIABLE, folder);
    shell.output().unwrap().status
}

#[test]
fn a_kill_in_mid_write_leaves_the_old_snapshot() {
    let folder = folder("kill");
    let store = SnapshotStore::new(&folder);
    store.save(1, &[state(3)]).unwrap();
    // The signal that the limit raises ends the process in the middle of the file.
    assert!(write_with_limit(&folder, "").code().is_none(), "the child was killed by a signal");
    assert_eq!(names(&folder), ["snapshot-000000000001.bin", "snapshot-000000000002.bin.tmp"]);
    let latest = store.latest().unwrap();
    assert_eq!((latest.step, latest.sections), (1, vec![state(3)]));
    store.save(3, &[state(4)]).unwrap();
    assert_eq!(names(&folder), ["snapshot-000000000001.bin", "snapshot-000000000003.bin"]);
}

#[test]
fn a_file_that_may_not_grow_is_an_error_and_leaves_the_old_snapshot() {
    let folder = folder("refused");
    let store = SnapshotStore::new(&folder);
    store.save(1, &[state(3)]).unwrap();
    assert!(write_with_limit(&folder, "trap '' XFSZ;").success(), "the child got its error");
    assert_eq!(names(&folder), ["snapshot-000000000001.bin"]);
    assert_eq!(store.latest().unwrap().step, 1);
}
