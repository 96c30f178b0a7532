//! Triangles of STL files, text or binary.

use std::io;
use std::path::Path;

/// Bytes before the triangles of a binary file: a title and their number.
const HEADER: usize = 84;
/// Bytes of one triangle: a normal, three corners, and two without use.
const RECORD: usize = 50;

/// Reads the triangles of an STL file, in the unit of the file (which it does not name). Normals are not read: they
/// follow from the corners.
///
/// # Errors
/// When the file cannot be read, is neither text nor binary STL, is cut short, or holds a number that is not finite.
pub fn read_stl(path: &Path) -> io::Result<Vec<[[f64; 3]; 3]>> {
    let bytes = std::fs::read(path)?;
    let triangles = match triangles_of_binary(&bytes) {
        Some(triangles) => triangles,
        None => triangles_of_text(&bytes)?,
    };
    if let Some(place) =
        triangles.iter().position(|triangle| triangle.as_flattened().iter().any(|x| !x.is_finite()))
    {
        return Err(invalid(format!("triangle {place} has a corner that is not finite")));
    }
    Ok(triangles)
}

fn invalid(reason: String) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, reason)
}

/// A binary file is told by its length alone: some begin with `solid` as those in text do.
fn triangles_of_binary(bytes: &[u8]) -> Option<Vec<[[f64; 3]; 3]>> {
    let count = u32::from_le_bytes(bytes.get(80..HEADER)?.try_into().ok()?) as usize;
    if bytes.len() != HEADER + RECORD.checked_mul(count)? {
        return None;
    }
    let number = |record: &[u8], place: usize| {
        let four = record[4 * place..4 * place + 4].try_into().expect("four bytes");
        f64::from(f32::from_le_bytes(four))
    };
    let records = bytes[HEADER..].chunks_exact(RECORD);
    Some(
        records
            .map(|record| {
                std::array::from_fn(|k| std::array::from_fn(|axis| number(record, 3 + 3 * k + axis)))
            })
            .collect(),
    )
}

fn triangles_of_text(bytes: &[u8]) -> io::Result<Vec<[[f64; 3]; 3]>> {
    let text = std::str::from_utf8(bytes).ok().filter(|text| text.trim_start().starts_with("solid"));
    let text = text.ok_or_else(|| {
        invalid(
            "neither STL in text, which begins with `solid`, nor binary STL of the length it says".to_owned(),
        )
    })?;
    if !text.contains("endsolid") {
        return Err(invalid("STL in text without `endsolid`: the file is cut short".to_owned()));
    }
    let mut corners = Vec::new();
    for (line, words) in text.lines().enumerate() {
        let mut words = words.split_whitespace();
        if words.next() != Some("vertex") {
            continue;
        }
        let numbers: Vec<f64> = words.map_while(|word| word.parse().ok()).collect();
        let corner = <[f64; 3]>::try_from(numbers);
        corners
            .push(corner.map_err(|_| invalid(format!("line {}: a vertex needs three numbers", line + 1)))?);
    }
    let (triangles, rest) = corners.as_chunks::<3>();
    if !rest.is_empty() {
        return Err(invalid(format!("{} vertices are not a whole number of triangles", corners.len())));
    }
    Ok(triangles.to_vec())
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "solid two\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex 0 1.5e0 0\n  \
                        endloop\n endfacet\nendsolid two\n";

    fn read(name: &str, bytes: &[u8]) -> io::Result<Vec<[[f64; 3]; 3]>> {
        let path = std::env::temp_dir().join(format!("granular-stl-{}-{name}", std::process::id()));
        std::fs::write(&path, bytes)?;
        let read = read_stl(&path);
        std::fs::remove_file(path)?;
        read
    }

    #[test]
    fn text_and_binary_give_the_same_triangles() {
        let expected = vec![[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.5, 0.0]]];
        assert_eq!(read("text", TEXT.as_bytes()).unwrap(), expected);
        let mut binary = b"solid that is none".to_vec();
        binary.resize(80, b' ');
        binary.extend(1_u32.to_le_bytes());
        let numbers = [0.0_f32, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.5, 0.0];
        numbers.iter().for_each(|number| binary.extend(number.to_le_bytes()));
        binary.extend([0, 0]);
        assert_eq!(read("binary", &binary).unwrap(), expected);
        binary.pop();
        assert!(read("short", &binary).unwrap_err().to_string().contains("the length it says"));
    }

    #[test]
    fn what_is_damaged_is_refused_with_the_place() {
        let refused = |name: &str, text: &str| read(name, text.as_bytes()).unwrap_err().to_string();
        assert!(refused("cut", &TEXT[..60]).contains("cut short"));
        assert!(refused("word", &TEXT.replace("1.5e0", "far")).contains("line 6"));
        assert!(refused("nan", &TEXT.replace("1.5e0", "NaN")).contains("triangle 0"));
        assert!(refused("missing", &TEXT.replace("   vertex 1 0 0\n", "")).contains("2 vertices"));
        assert!(refused("other", "hello").contains("neither"));
    }
}
