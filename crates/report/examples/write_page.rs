//! Writes a page about run folders: `write_page OUT FOLDER [FOLDER ...]`.

use granular_report::Request;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let out = arguments.next().ok_or("usage: write_page OUT FOLDER [FOLDER ...]")?;
    let written = granular_report::write(&Request::new(arguments, out))?;
    written.left_out.iter().for_each(|said| println!("{said}"));
    println!("{}: {} bytes", written.path.display(), written.bytes);
    Ok(())
}
