use super::*;
use std::path::PathBuf;

/// A folder of its own that is removed in the end.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("granular-scene-file-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    fn write(&self, name: &str, bytes: &[u8]) -> PathBuf {
        let path = self.0.join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

#[test]
fn a_file_is_read() {
    let folder = Folder::new("good");
    let path = folder.write("scene.ron", format!("\u{FEFF}{}", SAMPLE.replace('\n', "\r\n")).as_bytes());
    let scene = SceneText::read(&path).unwrap();
    assert_eq!(scene.name(), path.display().to_string());
    assert_eq!(scene.parse::<Scene>().unwrap(), sample().parse::<Scene>().unwrap());
}

#[test]
fn files_that_are_no_scenes_have_errors_of_their_own() {
    let folder = Folder::new("bad");
    let message = |path: PathBuf| {
        let problem = SceneText::read(&path).unwrap_err();
        assert_eq!(problem.place.file, Some(path.display().to_string()));
        (problem.message, problem.hint.unwrap_or_default())
    };
    assert_eq!(message(folder.write("empty.ron", b"")).0, "the file is empty");
    assert_eq!(message(folder.write("blank.ron", b" \n\t// nothing\n")).0, "the file holds no scene");
    let noise = message(folder.write("noise.ron", &[b'(', 0xff, 0xfe, 0x00]));
    assert_eq!(noise.0, "this is not a text: byte 1 (0xff) is not UTF-8");
    folder.write("scene.ron", b"()");
    let (text, hint) = message(folder.0.clone());
    assert_eq!(text, "this is a folder, not a scene file");
    assert!(hint.ends_with("scene.ron`?"));
    let (text, hint) = message(folder.0.join("scnee.ron"));
    assert_eq!(text, "there is no such file");
    assert!(hint.ends_with("scene.ron`?"), "{hint}");
    assert!(message(folder.0.join("none/scene.ron")).1.starts_with("there is no folder"));
}

#[test]
fn a_text_of_blanks_is_no_scene() {
    for text in ["", "  \n", "// nothing"] {
        let mut scene = SceneText::new("<stdin>", text);
        let problem = scene.parse::<Scene>().unwrap_err();
        assert!(problem.message.starts_with("the file "), "{problem}");
        assert!(problem.to_string().contains("--> <stdin>"));
        assert!(scene.set("a=1").is_err());
        assert_eq!(scene.locate("a"), None);
    }
}
