use super::*;
use crate::testing::Scratch;
use proptest::prelude::*;

const COLUMNS: [(&str, &str); 2] = [("time", "s"), ("overlap", "-")];

#[test]
fn rows_come_back_with_the_same_bits() {
    let folder = Scratch::new("table");
    let path = folder.path("series.csv");
    let numbers = [0.1 + 0.2, -0.0, f64::MIN_POSITIVE / 8.0, f64::MAX, 1e16, 9.999e-5, f64::INFINITY];
    let mut table = TableWriter::create(&path, &COLUMNS).unwrap();
    for value in numbers {
        table.row(&[value, f64::NAN]).unwrap();
    }
    assert_eq!(table.position(), fs::metadata(&path).unwrap().len());
    let text = fs::read_to_string(&path).unwrap();
    assert!(text.starts_with("time [s],overlap [-]\n0.30000000000000004,nan\n-0,nan\n"), "{text}");
    let back = read_table(&path).unwrap();
    assert_eq!(back.columns[1], ("overlap".to_owned(), "-".to_owned()));
    assert_eq!(back.unit("time"), Some("s"));
    let times = back.column("time").unwrap();
    assert!(times.iter().zip(numbers).all(|(a, b)| a.to_bits() == b.to_bits()));
    assert!(back.rows.iter().all(|row| row[1].is_nan()));
}

#[test]
fn a_resumed_table_has_no_rows_after_the_cut() {
    let folder = Scratch::new("reopen");
    let path = folder.path("series.csv");
    let mut table = TableWriter::create(&path, &COLUMNS).unwrap().flush_every_row(false);
    table.row(&[1.0, 2.0]).unwrap();
    let bytes = table.position();
    assert!(bytes > fs::metadata(&path).unwrap().len(), "the row is not handed over yet");
    table.row(&[3.0, 4.0]).unwrap();
    drop(table);
    let mut table = TableWriter::reopen_at(&path, &COLUMNS, bytes).unwrap();
    table.row(&[5.0, 6.0]).unwrap();
    assert_eq!(read_table(&path).unwrap().rows, [[1.0, 2.0], [5.0, 6.0]]);
}

#[test]
fn what_does_not_fit_is_refused_and_the_file_stays() {
    let folder = Scratch::new("refuse");
    let path = folder.path("series.csv");
    let mut table = TableWriter::create(&path, &COLUMNS).unwrap();
    table.row(&[1.0, 2.0]).unwrap();
    assert!(table.row(&[1.0]).unwrap_err().reason.contains("1 values for 2 columns"));
    let end = table.position();
    let before = fs::read(&path).unwrap();
    let other = TableWriter::reopen_at(&path, &[("time", "ms"), ("overlap", "-")], end).unwrap_err();
    assert!(other.reason.contains("`time [s],overlap [-]` where `time [ms],overlap [-]`"), "{other}");
    for bytes in [0, 3, end - 1, end + 1, u64::MAX] {
        assert!(TableWriter::reopen_at(&path, &COLUMNS, bytes).is_err(), "{bytes}");
    }
    assert_eq!(fs::read(&path).unwrap(), before);
    assert!(TableWriter::create(&path, &[("a,b", "s")]).is_err());
    assert!(TableWriter::create(&path, &[("a", "s"), ("a", "m")]).is_err());
    assert_eq!(fs::read(&path).unwrap(), before);
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_is_an_error() {
    let full = TableWriter::create(Path::new("/dev/full"), &COLUMNS).unwrap_err().to_string();
    assert!(full.contains("could not write `/dev/full`: No space left"), "{full}");
}

#[test]
fn a_bad_line_is_named() {
    let wrong = parse_table("time [s],x\n1,2\n\n3,fast\n").unwrap_err();
    assert_eq!(wrong, "line 4, column `x`: `fast` is not a number");
    let short = parse_table("# source\r\n\"time [s]\",\"x\"\r\n1,2\r\n3").unwrap_err();
    assert_eq!(short, "line 4 has 1 fields where the header has 2");
    assert!(parse_table("").is_err());
    assert!(parse_table("a,b\n1,\n").unwrap().rows[0][1].is_nan());
}

#[test]
fn a_header_with_commas_marks_and_blanks_is_read_like_any_other() {
    // As a spreadsheet writes it, and with blanks as people type them.
    let text = "\u{feff}\"speed, mean [m/s]\", time [s] \r\n \r\n\"1\" , 2\r\n# note\r\n3,4\r\n";
    let table = parse_table(text).unwrap();
    assert_eq!(table.unit("speed, mean"), Some("m/s"));
    assert_eq!(table.rows, [[1.0, 2.0], [3.0, 4.0]]);
    assert_eq!(parse_table(&format!("{text}5")).unwrap_err(), "line 6 has 1 fields where the header has 2");
}

/// Tables of runs that began before are continued and compared byte by byte: this is what was written then.
#[test]
fn the_text_of_a_table_does_not_change() {
    let folder = Scratch::new("text");
    let path = folder.path("series.csv");
    let mut table = TableWriter::create(&path, &[("time", "s"), ("count", ""), ("a \u{3b4}", "-")]).unwrap();
    table.row(&[1e-5, 3.0, 0.1 + 0.2]).unwrap();
    table.row(&[f64::NAN, -0.0, f64::NEG_INFINITY]).unwrap();
    table.row(&[1e16, 123456.0, 1.0 / 3.0]).unwrap();
    drop(table);
    let expected = "time [s],count,a \u{3b4} [-]\n1e-5,3,0.30000000000000004\nnan,-0,-inf\n1e16,123456,0.3333333333333333\n";
    assert_eq!(fs::read_to_string(path).unwrap(), expected);
    // The form of a row with every kind of field.
    assert_eq!(csv_row(["a", "", "b \"c\"", "d\ne", "#f", " g"]), "a,,\"b \"\"c\"\"\",\"d\ne\",#f, g\n");
}

proptest! {
    #[test]
    fn rows_of_any_text_come_back(fields in prop::collection::vec("[a-z,\"\n#é-]{1,8}", 1..6)) {
        let row = csv_row(["first"].into_iter().chain(fields.iter().map(String::as_str)));
        let back: Vec<CsvRow> = csv_rows(&row).collect();
        prop_assert_eq!(back.len(), 1);
        let back: Vec<&str> = back[0].fields().skip(1).collect();
        prop_assert_eq!(back, fields.iter().map(|field| field.trim()).collect::<Vec<_>>());
    }

    #[test]
    fn every_number_reads_back_as_itself(bits: u64) {
        let value = f64::from_bits(bits);
        let back: f64 = shortest(value).parse().unwrap();
        prop_assert!(back.to_bits() == bits || value.is_nan() && back.is_nan());
    }

    #[test]
    fn no_text_makes_the_reader_panic(text in "[a-z0-9,\"\\[\\]\n#. -]*") {
        let _ = parse_table(&text);
    }
}
