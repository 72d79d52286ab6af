//! A glTF or GLB file with its buffers; every index into it is checked.

use std::fs;
use std::path::{Path, PathBuf};

use ::gltf::json::buffer::{Buffer, Stride, View};
use ::gltf::json::root::Get;
use ::gltf::json::validation::USize64;
use ::gltf::json::{Index, Root};
use ::gltf::{Glb, json};
use data_url::DataUrl;
use percent_encoding::percent_decode_str;

use super::extensions::is_readable;
use crate::error::{Error, Result};
use crate::scene::named::find;

/// The parsed JSON and the bytes it refers to.
///
/// The crate's own document is left aside: its accessors unwrap what its validation lets pass.
#[derive(Debug)]
pub(super) struct GltfFile {
    pub(super) path: PathBuf,
    pub(super) root: Root,
    /// `None` for buffers without data, which only compression extensions may fill.
    buffers: Vec<Option<Vec<u8>>>,
}

impl GltfFile {
    /// Reads the file and all buffers; which files were taken instead of others is noted.
    pub(super) fn open(path: &Path, notes: &mut Vec<String>) -> Result<Self> {
        let bytes = fs::read(path).map_err(Error::io(path))?;
        let (root, mut blob) = parse(path, &bytes)?;
        let mut file = Self { path: path.to_owned(), root, buffers: Vec::new() };
        file.refuse_unreadable_extensions()?;
        for index in 0..file.root.buffers.len() {
            let data = file.buffer(index, &mut blob, notes)?;
            file.buffers.push(data);
        }
        Ok(file)
    }

    /// An error about this file.
    pub(super) fn fail(&self, message: impl Into<String>) -> Error {
        Error::format(&self.path, message)
    }

    /// The item that `index` names, or an error that says `what` was looked for.
    pub(super) fn get<T>(&self, index: Index<T>, what: &str) -> Result<&T>
    where
        Root: Get<T>,
    {
        let missing = || self.fail(format!("{what} {index} does not exist"));
        self.root.get(index).ok_or_else(missing)
    }

    /// The bytes of a buffer view and its stride, if it has one.
    pub(super) fn view(&self, index: Index<View>) -> Result<(&[u8], Option<usize>)> {
        let view = self.get(index, "buffer view")?;
        let bytes = self.bytes(view.buffer, view.byte_offset.unwrap_or_default(), view.byte_length);
        let packed = view.extensions.as_ref().and_then(|all| all.others.keys().next());
        let packed = packed
            .map_or_else(String::new, |name| format!(" (compressed by {name}, which is not read)"));
        let outside = || {
            self.fail(format!("buffer view {index} lies outside buffer {}{packed}", view.buffer))
        };
        Ok((bytes.ok_or_else(outside)?, view.byte_stride.map(|stride| stride.0)))
    }

    /// Some bytes of a buffer, if they are there.
    pub(super) fn bytes(
        &self,
        buffer: Index<Buffer>,
        start: USize64,
        length: USize64,
    ) -> Option<&[u8]> {
        let data = self.buffers.get(buffer.value())?.as_deref()?;
        let [start, length] = [start, length].map(|number| usize::try_from(number.0).ok());
        data.get(start?..start?.checked_add(length?)?)
    }

    /// A view of bytes that are not in the file, which are kept as a buffer.
    pub(super) fn add_bytes(&mut self, bytes: Vec<u8>, byte_stride: Option<Stride>) -> View {
        let (buffer, byte_length) = (Index::new(self.buffers.len() as u32), bytes.len().into());
        self.buffers.push(Some(bytes));
        View {
            buffer,
            byte_length,
            byte_offset: None,
            byte_stride,
            name: None,
            target: None,
            extensions: None,
            extras: None,
        }
    }

    /// The bytes behind a URI: `data:`, or a file beside this one; which one was taken instead of another is noted.
    pub(super) fn resource(&self, uri: &str, notes: &mut Vec<String>) -> Result<Vec<u8>> {
        if uri.starts_with("data:") {
            let url = DataUrl::process(uri).map_err(|_| self.fail("malformed data: URI"))?;
            let decoded = url.decode_to_vec();
            return Ok(decoded.map_err(|error| self.fail(format!("data: URI: {error}")))?.0);
        }
        let path = self.beside(uri, notes)?;
        fs::read(&path).map_err(Error::io(&path))
    }

    /// The file that a URI is about, beside this one; if there is none, where it should be.
    fn beside(&self, uri: &str, notes: &mut Vec<String>) -> Result<PathBuf> {
        if uri.contains("://") && !uri.to_ascii_lowercase().starts_with("file:") {
            return Err(
                self.fail(format!("\"{uri}\": only data: URIs and relative paths are read"))
            );
        }
        let name = percent_decode_str(uri).decode_utf8();
        let name = name.map_err(|_| self.fail(format!("\"{uri}\" is not UTF-8 when decoded")))?;
        let folder = self.path.parent().unwrap_or(Path::new(""));
        // Exporters also write names as they are, with escapes in them.
        let as_written = Some(folder.join(uri)).filter(|path| path.is_file());
        let path = as_written.or_else(|| find(folder, &name, notes));
        Ok(path.unwrap_or_else(|| folder.join(name.as_ref())))
    }

    /// The file itself, and all that it refers to; those that cannot be read are told of when they are to be.
    pub(super) fn files(&self) -> Vec<PathBuf> {
        let buffers = self.root.buffers.iter().filter_map(|buffer| buffer.uri.as_deref());
        let images = self.root.images.iter().filter_map(|image| image.uri.as_deref());
        let relative = buffers.chain(images).filter(|uri| !uri.starts_with("data:"));
        let beside = relative.filter_map(|uri| self.beside(uri, &mut Vec::new()).ok());
        [self.path.clone()].into_iter().chain(beside).collect()
    }

    fn buffer(
        &self,
        index: usize,
        blob: &mut Option<Vec<u8>>,
        notes: &mut Vec<String>,
    ) -> Result<Option<Vec<u8>>> {
        let buffer = &self.root.buffers[index];
        let data = match &buffer.uri {
            Some(uri) => Some(self.resource(uri, notes)?),
            None if index == 0 => blob.take(),
            None => None,
        };
        match data {
            Some(data) if (data.len() as u64) < buffer.byte_length.0 => Err(self.fail(format!(
                "buffer {index} has {} bytes instead of {}",
                data.len(),
                buffer.byte_length.0
            ))),
            data => Ok(data),
        }
    }

    fn refuse_unreadable_extensions(&self) -> Result<()> {
        match self.root.extensions_required.iter().find(|name| !is_readable(name)) {
            Some(name) => {
                Err(self.fail(format!("requires the extension {name}, which is not read")))
            }
            None => Ok(()),
        }
    }
}

/// What the file says its version is, if that is not one that is read.
fn other_version(json: &[u8]) -> Option<String> {
    let root: serde_json::Value = serde_json::from_slice(json).ok()?;
    let version = root.pointer("/asset/version").or(root.get("version"));
    let version = version.map_or_else(|| "1.0".to_owned(), |version| version.to_string());
    let version = version.trim_matches('"').to_owned();
    (!version.starts_with('2')).then_some(version)
}

fn parse(path: &Path, bytes: &[u8]) -> Result<(Root, Option<Vec<u8>>)> {
    if !bytes.starts_with(b"glTF") {
        let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        let wrong = |error: json::Error| match other_version(text) {
            Some(version) => Error::format(path, only_version_2(&version)),
            None => Error::Format {
                path: path.to_owned(),
                line: Some(error.line()).filter(|&line| line > 0),
                message: format!("not valid glTF: {error}"),
            },
        };
        return Ok((Root::from_slice(text).map_err(wrong)?, None));
    }
    if bytes.get(4..8) == Some(&1u32.to_le_bytes()) {
        return Err(Error::format(path, only_version_2("1")));
    }
    // The crate subtracts the header's 12 bytes from the length without looking.
    let length = bytes.get(8..12).map(|l| u32::from_le_bytes([l[0], l[1], l[2], l[3]]));
    if length.is_none_or(|length| length < 12) {
        return Err(Error::format(path, "the GLB header is cut short"));
    }
    let wrong = |why: String| Error::format(path, format!("not valid GLB: {why}"));
    let glb = Glb::from_slice(bytes).map_err(|error| wrong(error.to_string()))?;
    let root = Root::from_slice(&glb.json).map_err(|error| wrong(error.to_string()))?;
    Ok((root, glb.bin.map(|bin| bin.into_owned())))
}

fn only_version_2(version: &str) -> String {
    format!("glTF of version {version}; only version 2 is read")
}
