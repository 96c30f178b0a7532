//! Rows of CSV that hold texts.

/// A row of CSV, with its line break. A field with commas, quotes or line breaks stands in quotes (RFC 4180).
///
/// ```
/// assert_eq!(granular_io::csv_row(["disks, soft", "0.5"]), "\"disks, soft\",0.5\n");
/// ```
pub fn csv_row(fields: impl IntoIterator<Item = impl AsRef<str>>) -> String {
    let fields: Vec<String> = fields.into_iter().map(|field| quoted(field.as_ref())).collect();
    fields.join(",") + "\n"
}

fn quoted(field: &str) -> String {
    if field.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", field.replace('"', "\"\""))
    } else {
        field.to_owned()
    }
}
