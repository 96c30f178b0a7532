//! The script of a Slurm array job that works through a sweep.

use super::{Plan, Request};
use std::path::Path;

/// A script whose task k works on the k-th run of the grid. The same sweep without `--slurm` collects
/// the table when the tasks have ended.
pub fn array_script(plan: &Plan, request: &Request, out: &Path, threads: usize) -> String {
    let edits: String = request.set.iter().map(|edit| format!(" --set {}", quoted(edit))).collect();
    let scene = quoted(&request.scene.display().to_string());
    let sweep = format!("sweep {scene}{edits} --out {}", quoted(&out.display().to_string()));
    let (count, last) = (plan.points.len(), plan.points.len() - 1);
    format!(
        "#!/bin/bash\n\
         # A sweep of {count} runs, one task each. Submit it with sbatch from the folder in which it was made, with what\n\
         # your machine asks for, such as --time, --mem and --partition. A task that ran out of time continues where it\n\
         # was when the script is submitted again; what is done stays. In the end this collects the table:\n\
         #   granular {sweep}\n\
         #SBATCH --job-name=granular\n\
         #SBATCH --array=0-{last}\n\
         #SBATCH --cpus-per-task={threads}\n\
         #SBATCH --signal=B:TERM@120\n\
         exec \"${{GRANULAR:-granular}}\" {sweep} \\\n    \
         --only \"$SLURM_ARRAY_TASK_ID\" --threads {threads} --quiet\n"
    )
}

/// A word of the shell.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "._-/=,:".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}
