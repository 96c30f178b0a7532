use super::*;
use crate::scene_file::reference::markdown;

#[test]
fn every_type_has_a_section_and_every_link_a_target() {
    let page = markdown(&schemars::schema_for!(Scene), "Keys of a scene");
    let headings: Vec<String> =
        page.lines().filter_map(|line| line.strip_prefix("## ")).map(str::to_lowercase).collect();
    let links: Vec<&str> = page.split("](#").skip(1).filter_map(|rest| rest.split(')').next()).collect();
    assert!(links.len() > 9, "{page}");
    for link in links {
        assert_eq!(headings.iter().filter(|heading| *heading == link).count(), 1, "{link}\n{page}");
    }
    for name in ["scene", "material", "sample", "grading", "packing", "demspec", "every"] {
        assert!(headings.iter().any(|heading| heading == name), "{name}");
    }
}

#[test]
fn rows_tell_unit_default_and_meaning_in_the_order_of_the_type() {
    let page = markdown(&schemars::schema_for!(Scene), "Keys of a scene");
    let rows = [
        "# Keys of a scene\n\n## Scene\n\nA scene for tests.\n\n| key | type or unit | default | meaning |\n|---|---|---|---|\n| `version` | whole number at least 0 | required | Version of the format. |\n",
        "| `gravity` | list of number | required | Gravity, by component. |",
        "| `materials` | map from names to [Material](#material) | required |  |",
        "| `stages` | list of (text, [Ending](#ending)) | required |  |",
        "What grains are made of; see `Sample`.",
        "| `density` | density \\[kg/m^3\\] | required |  |",
        "| `friction` | number | required | Coulomb's coefficient \\| between equal grains. |",
        "| `restitution` | number | `1.0` |  |",
        "| `normal_stiffness` | stiffness \\[N/m\\], or `None` | optional |  |",
        "| `Column(...)`, keys below | A rectangle of grains. |",
        "| `Grains`(list of (number, number)) | Grains one by one. |",
        "### Sample: Column\n\n| key |",
        "| `width` | length \\[m\\] | required | Width at rest. |",
        "| `packing` | [Packing](#packing) | `Ballistic` |  |",
        "| `Ballistic` | Dropped one after the other. |",
        "| `For`(time \\[s\\]) |  |",
        "| `Dem`([DemSpec](#demspec)) |  |",
    ];
    for row in rows {
        assert!(page.contains(row), "{row}\n{page}");
    }
}

#[test]
fn a_type_within_itself_is_described_once() {
    /// A tree.
    #[derive(JsonSchema)]
    #[expect(dead_code, reason = "only its schema is wanted")]
    struct Branch {
        branches: Vec<Branch>,
    }
    let page = markdown(&schemars::schema_for!(Branch), "Trees");
    assert_eq!(page.matches("## Branch").count(), 1, "{page}");
    assert!(page.contains("| `branches` | list of [Branch](#branch) |"), "{page}");
}
