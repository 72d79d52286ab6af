//! glTF files made in tests.

use std::fmt::Write;

use radiosity::scene::Scene;
use serde_json::{Value, json};

use super::Folder;

/// A glTF file in the making: JSON, and bytes that accessors are appended to.
pub(crate) struct Asset {
    pub(crate) json: Value,
    pub(crate) bytes: Vec<u8>,
}

pub(crate) fn floats(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

const TRIANGLE: [f32; 9] = [0., 0., 0., 1., 0., 0., 0., 1., 0.];
pub(crate) const FLOAT: u32 = 5126;

impl Asset {
    /// One triangle in the plane z = 0, facing +Z, under one node.
    pub(crate) fn triangle() -> Self {
        let json = json!({
            "asset": {"version": "2.0"},
            "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
            "materials": [{"name": "m", "pbrMetallicRoughness":
                {"baseColorFactor": [0.5, 0.5, 0.5, 1], "metallicFactor": 0}}],
            "bufferViews": [], "accessors": [],
        });
        let mut asset = Self { json, bytes: Vec::new() };
        asset.add(&floats(&TRIANGLE), FLOAT, "VEC3", 3);
        asset
    }

    /// Appends a view of `data` and an accessor over it; both get the returned index.
    pub(crate) fn add(&mut self, data: &[u8], component: u32, type_: &str, count: u64) -> usize {
        let views = self.json["bufferViews"].as_array_mut().unwrap();
        views.push(json!({"buffer": 0, "byteOffset": self.bytes.len(), "byteLength": data.len()}));
        let view = views.len() - 1;
        self.bytes.extend(data);
        let accessors = self.json["accessors"].as_array_mut().unwrap();
        accessors.push(
            json!({"bufferView": view, "componentType": component, "type": type_, "count": count}),
        );
        accessors.len() - 1
    }

    pub(crate) fn attribute(
        mut self,
        name: &str,
        data: &[u8],
        component: u32,
        type_: &str,
    ) -> Self {
        let index = self.add(data, component, type_, 3);
        self.json["meshes"][0]["primitives"][0]["attributes"][name] = json!(index);
        self
    }

    pub(crate) fn set(mut self, pointer: &str, value: Value) -> Self {
        if let Some(place) = self.json.pointer_mut(pointer) {
            *place = value;
        } else {
            let (parent, key) = pointer.rsplit_once('/').unwrap();
            self.json.pointer_mut(parent).unwrap()[key] = value;
        }
        self
    }

    /// The file's text, its bytes in a percent-encoded `data:` URI.
    pub(crate) fn text(&self) -> String {
        let mut uri = "data:application/octet-stream,".to_owned();
        for byte in &self.bytes {
            write!(uri, "%{byte:02x}").unwrap();
        }
        let mut json = self.json.clone();
        json["buffers"] = json!([{"byteLength": self.bytes.len(), "uri": uri}]);
        json.to_string()
    }

    /// The same as GLB.
    pub(crate) fn glb(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        json["buffers"] = json!([{"byteLength": self.bytes.len()}]);
        let mut text = json.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let mut bin = self.bytes.clone();
        bin.resize(bin.len().next_multiple_of(4), 0);
        let mut glb = b"glTF".to_vec();
        let length = 12 + 8 + text.len() + 8 + bin.len();
        for (word, data) in [(b"JSON", text), (b"BIN\0", bin)] {
            if glb.len() == 4 {
                glb.extend([2u32.to_le_bytes(), (length as u32).to_le_bytes()].concat());
            }
            glb.extend((data.len() as u32).to_le_bytes());
            glb.extend(word);
            glb.extend(data);
        }
        glb
    }

    pub(crate) fn try_load(&self) -> radiosity::Result<Scene> {
        Folder::new().with("a.gltf", self.text()).load("a.gltf")
    }

    pub(crate) fn load(&self) -> Scene {
        self.try_load().expect("a readable scene")
    }

    pub(crate) fn error(&self) -> String {
        self.try_load().expect_err("an unreadable scene").to_string()
    }
}
