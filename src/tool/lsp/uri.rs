//! URIs of files.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// The path of a `file:` URI, `%XX` decoded.
pub(super) fn path_of(uri: &str) -> PathBuf {
    let rest = uri.strip_prefix("file://").unwrap_or(uri);
    let mut bytes = Vec::with_capacity(rest.len());
    let mut signs = rest.bytes();
    while let Some(byte) = signs.next() {
        let digits = || {
            let text: String = signs.clone().take(2).map(char::from).collect();
            u8::from_str_radix(&text, 16).ok()
        };
        match (byte, digits()) {
            (b'%', Some(decoded)) => {
                bytes.push(decoded);
                signs.nth(1);
            }
            _ => bytes.push(byte),
        }
    }
    let path = String::from_utf8_lossy(&bytes).into_owned();
    // A drive letter has a slash before it.
    let drive = path.get(2..3) == Some(":");
    PathBuf::from(if drive { path[1..].to_owned() } else { path })
}

/// The `file:` URI of a path with `/`.
pub(super) fn uri_of(path: &str) -> String {
    let mut uri = "file://".to_owned();
    if !path.starts_with('/') {
        uri.push('/');
    }
    for byte in path.bytes() {
        if byte.is_ascii_alphanumeric() || b"/-._~".contains(&byte) {
            uri.push(char::from(byte));
        } else {
            // Writing to a string does not fail.
            let _ = write!(uri, "%{byte:02X}");
        }
    }
    uri
}

/// A path with `/`.
pub(super) fn shown(path: &Path) -> String {
    path.to_string_lossy().replace('\\', "/")
}

/// The folder of a document.
pub(super) fn folder_of(uri: &str) -> PathBuf {
    path_of(uri).parent().map(Path::to_path_buf).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_and_uris_are_converted() {
        for path in ["/a b/Größe.mod", "/x%20y.mod", "C:/cell/Main.mod"] {
            assert_eq!(shown(&path_of(&uri_of(path))), path);
        }
        assert_eq!(uri_of("/a b/ü.mod"), "file:///a%20b/%C3%BC.mod");
        assert_eq!(shown(&path_of("file:///c%3A/x.mod")), "c:/x.mod");
    }
}
