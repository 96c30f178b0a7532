//! What the machine has: memory that may still be taken, and threads that make sense.
//!
//! Counts in a scene are compared with it before anything is laid out: a slip of the pen must not take all memory.

use std::fs;
use std::path::Path;

/// Part of the free memory that one thing may ask for.
const SHARE: f64 = 0.9;
/// Free memory where the system does not tell \[bytes\].
const UNKNOWN: f64 = 16e9;
/// Threads that may share a core; more only wait for one another.
const THREADS_PER_CORE: usize = 4;
/// Threads that any machine may be asked for, to try that results are the same.
const LEAST_THREADS: usize = 32;

/// Whether the machine has room for `count` things that take about `bytes` \[bytes\] each.
///
/// # Errors
/// With what is allowed, in words.
pub fn room_for(count: f64, bytes: f64) -> Result<(), String> {
    let free = SHARE * free_memory();
    if count * bytes <= free {
        return Ok(());
    }
    let most = (free / bytes).floor();
    // Round numbers read better than those of a moment.
    let digits = 10.0_f64.powf(most.max(1.0).log10().floor() - 1.0).max(1.0);
    let most = (most / digits).floor() * digits;
    Err(format!(
        "at most {most:.0} on this machine: each takes about {}, and {} of memory are free",
        in_words(bytes),
        in_words(free)
    ))
}

/// Most things of about `bytes` \[bytes\] each for which the machine has room.
pub(crate) fn most(bytes: f64) -> f64 {
    (SHARE * free_memory() / bytes).floor()
}

/// Whether a file can be read whole, where each byte of it takes about `bytes` \[bytes\] of memory.
///
/// # Errors
/// With what is wrong, in words.
#[cfg(any(feature = "dem", feature = "mpm"))]
pub(crate) fn readable(path: &Path, bytes: f64) -> Result<(), String> {
    let data = fs::metadata(path).map_err(|error| error.to_string())?;
    if !data.is_file() {
        return Err("it is not a file".to_owned());
    }
    let length = data.len() as f64;
    match room_for(length, bytes) {
        Ok(()) => Ok(()),
        Err(_) => {
            Err(format!("it is of {}, more than the memory of this machine can hold", in_words(length)))
        }
    }
}

/// Bytes as people read them.
pub(crate) fn in_words(bytes: f64) -> String {
    let units = ["bytes", "kB", "MB", "GB", "TB", "PB"];
    let power = if bytes >= 1.0 { ((bytes.log10() / 3.0) as usize).min(units.len() - 1) } else { 0 };
    let value = bytes / 1000.0_f64.powi(power as i32);
    if power == 0 { format!("{value:.0} bytes") } else { format!("{value:.1} {}", units[power]) }
}

/// Most threads that a command may use here.
pub fn most_threads() -> usize {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    (THREADS_PER_CORE * cores).max(LEAST_THREADS)
}

/// Memory that may still be taken: the least of what the system has free, what control groups leave, and what limits of
/// the process leave \[bytes\].
fn free_memory() -> f64 {
    let of_system = fs::read_to_string("/proc/meminfo").ok().and_then(|text| available(&text));
    let of_group = fs::read_to_string("/proc/self/cgroup").ok().and_then(|text| left_in_groups(&text));
    let of_process = left_to_process();
    [of_system, of_group, of_process].into_iter().flatten().fold(f64::INFINITY, f64::min).min(
        // Where the system tells nothing.
        if of_system.is_none() && of_group.is_none() && of_process.is_none() {
            UNKNOWN
        } else {
            f64::INFINITY
        },
    )
}

/// `MemAvailable` of `/proc/meminfo` \[bytes\].
fn available(meminfo: &str) -> Option<f64> {
    in_kilobytes(meminfo, "MemAvailable:")
}

/// A line such as `VmSize:   1234 kB` \[bytes\].
fn in_kilobytes(text: &str, name: &str) -> Option<f64> {
    let line = text.lines().find_map(|line| line.strip_prefix(name))?;
    line.split_whitespace().next()?.parse::<f64>().ok().map(|kilobytes| kilobytes * 1024.0)
}

/// The least that control groups, of version 2 or 1, leave to the process: its own and those above \[bytes\].
fn left_in_groups(groups: &str) -> Option<f64> {
    let mut least: Option<f64> = None;
    for line in groups.lines() {
        let mut parts = line.splitn(3, ':').skip(1);
        let (Some(controllers), Some(path)) = (parts.next(), parts.next()) else { continue };
        let (root, limit, usage, cache) = match controllers {
            "" => ("/sys/fs/cgroup", "memory.max", "memory.current", ["inactive_file ", "active_file "]),
            names if names.split(',').any(|name| name == "memory") => (
                "/sys/fs/cgroup/memory",
                "memory.limit_in_bytes",
                "memory.usage_in_bytes",
                ["total_inactive_file ", "total_active_file "],
            ),
            _ => continue,
        };
        for group in Path::new(path.trim_start_matches('/')).ancestors() {
            let folder = Path::new(root).join(group);
            let number = |name: &str| fs::read_to_string(folder.join(name)).ok()?.trim().parse::<f64>().ok();
            let (Some(limit), Some(usage)) = (number(limit), number(usage)) else { continue };
            // Pages of files are given up for others.
            let stat = fs::read_to_string(folder.join("memory.stat")).unwrap_or_default();
            let cached: f64 = cache
                .iter()
                .filter_map(|name| stat.lines().find_map(|line| line.strip_prefix(name))?.parse::<f64>().ok())
                .sum();
            let left = (limit - usage + cached).max(0.0);
            least = Some(least.map_or(left, |least| least.min(left)));
        }
    }
    least
}

/// What `ulimit -v` leaves \[bytes\].
fn left_to_process() -> Option<f64> {
    let limits = fs::read_to_string("/proc/self/limits").ok()?;
    let line = limits.lines().find_map(|line| line.strip_prefix("Max address space"))?;
    let limit: f64 = line.split_whitespace().next()?.parse().ok()?;
    let status = fs::read_to_string("/proc/self/status").ok()?;
    Some((limit - in_kilobytes(&status, "VmSize:")?).max(0.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_free_is_read_from_the_system() {
        let text = "MemTotal:       16384000 kB\nMemFree:          1000 kB\nMemAvailable:    8192 kB\n";
        assert_eq!(available(text), Some(8192.0 * 1024.0));
        assert_eq!(available("nothing of this kind"), None);
        let free = free_memory();
        assert!(free > 1e6 && free < 1e15, "{free}");
    }

    #[test]
    fn more_than_the_machine_holds_is_refused_with_what_it_holds() {
        assert_eq!(room_for(1e6, 1.0), Ok(()));
        let refused = room_for(1e15, 1000.0).unwrap_err();
        assert!(refused.starts_with("at most ") && refused.contains("each takes about 1.0 kB"), "{refused}");
        assert!(room_for(f64::INFINITY, 1.0).is_err());
        assert!(room_for(f64::NAN, 1.0).is_err());
    }

    #[test]
    fn bytes_have_a_unit() {
        assert_eq!(
            [0.0, 999.0, 2e3, 7.04e9, 1e20].map(in_words),
            ["0 bytes", "999 bytes", "2.0 kB", "7.0 GB", "100000.0 PB"]
        );
    }
}
