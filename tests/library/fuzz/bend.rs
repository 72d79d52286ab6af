//! Changes to files: of bytes, of words and lines, of JSON by its structure.

use fastrand::Rng;
use serde_json::{Value, json};

/// Words that readers stumble over.
const WORDS: [&str; 30] = [
    "nan",
    "inf",
    "-1",
    "0",
    "-0",
    "1",
    "2",
    "3",
    "1e999",
    "1e38",
    "-1e300",
    "1e-30",
    "1e8",
    "0.5000001",
    "99999999999999999999",
    "4294967295",
    "4294967296",
    "-9223372036854775808",
    "/",
    "//",
    "\\",
    "\"",
    "#",
    "\u{fffd}",
    "\u{feff}",
    "on",
    "off",
    "-s",
    "v",
    "f",
];

fn pick<T: Clone>(rng: &mut Rng, list: &[T]) -> T {
    list[rng.usize(..list.len())].clone()
}

/// How often a case is changed: once or twice mostly.
pub(crate) fn often(rng: &mut Rng) -> usize {
    if rng.u8(..) < 200 { rng.usize(1..4) } else { rng.usize(4..24) }
}

/// Bytes flipped, cut, doubled, dropped from the end.
pub(crate) fn bytes(rng: &mut Rng, bytes: &mut Vec<u8>) {
    if bytes.is_empty() {
        return;
    }
    let at = rng.usize(..bytes.len());
    let end = (at + rng.usize(1..40)).min(bytes.len());
    match rng.u8(..8) {
        0..3 => bytes[at] ^= 1 << rng.u8(..8),
        3 => bytes[at] = rng.u8(..),
        4 => drop(bytes.drain(at..end)),
        5 => {
            let copy = bytes[at..end].to_vec();
            bytes.splice(at..at, copy);
        }
        6 => drop(bytes.splice(at..at, pick(rng, &WORDS).bytes())),
        _ => bytes.truncate(at),
    }
}

/// Lines and words of a text exchanged, doubled, dropped, replaced, and numbers moved a little.
pub(crate) fn text(rng: &mut Rng, bytes: &mut Vec<u8>) {
    if rng.u8(..8) == 0 {
        return self::bytes(rng, bytes);
    }
    let text = String::from_utf8_lossy(bytes);
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    if lines.is_empty() {
        return;
    }
    let (at, other) = (rng.usize(..lines.len()), rng.usize(..lines.len()));
    match rng.u8(..12) {
        0 => drop(lines.remove(at)),
        1 => lines.insert(other, lines[at].clone()),
        2 => lines.swap(at, other),
        3 => lines[at] = format!("{} {}", lines[at], lines[other]),
        4 => lines[at] = format!("{} \\", lines[at]),
        _ => lines[at] = bent_line(rng, &lines[at], &lines[other]),
    }
    let ending = if rng.u8(..16) == 0 { "\r\n" } else { "\n" };
    *bytes = lines.join(ending).into_bytes();
}

fn bent_line(rng: &mut Rng, line: &str, other: &str) -> String {
    let mut words: Vec<String> = line.split_whitespace().map(str::to_owned).collect();
    let others: Vec<&str> = other.split_whitespace().collect();
    if words.is_empty() {
        return line.to_owned();
    }
    let at = rng.usize(..words.len());
    match rng.u8(..10) {
        0 => drop(words.remove(at)),
        1 => words.insert(at, pick(rng, &WORDS).to_owned()),
        2 => words.swap(at, 0),
        3..5 => words[at] = pick(rng, &WORDS).to_owned(),
        5 if !others.is_empty() => words[at] = pick(rng, &others).to_owned(),
        6 => words[1.min(at)..].reverse(),
        _ => words[at] = moved(rng, &words[at]),
    }
    words.join(pick(rng, &[" ", "\t", "  "]))
}

/// A number near another, or of another size; what is no number stays.
fn moved(rng: &mut Rng, word: &str) -> String {
    let Ok(number) = word.parse::<f64>() else { return word.to_owned() };
    match rng.u8(..6) {
        0 => number + 1e-7 * (rng.f64() - 0.5),
        1 => number + 1e-3 * (rng.f64() - 0.5),
        2 => number + rng.f64() - 0.5,
        3 => -number,
        4 => number * pick(rng, &[1e-6, 1e-3, 10.0, 1e3, 1e6]),
        _ => number + 1.0,
    }
    .to_string()
}

/// Values of a JSON tree replaced, dropped, doubled, exchanged, and known keys put where they do not belong.
pub(crate) fn tree(rng: &mut Rng, root: &mut Value) {
    let mut places = Vec::new();
    list_places(root, String::new(), &mut places);
    let (at, other) = (pick(rng, &places), pick(rng, &places));
    let other = root.pointer(&other).cloned().unwrap_or_default();
    let Some(value) = root.pointer_mut(&at) else { return };
    match value {
        Value::Array(list) if rng.bool() && !list.is_empty() => {
            let index = rng.usize(..list.len());
            match rng.u8(..3) {
                0 => drop(list.remove(index)),
                1 => list.push(list[index].clone()),
                _ => list[index] = other,
            }
        }
        Value::Object(fields) if rng.bool() => {
            let keys: Vec<String> = fields.keys().cloned().collect();
            if rng.bool() && !keys.is_empty() {
                fields.remove(&pick(rng, &keys));
            } else {
                let (key, value) = pick(rng, &foreign());
                fields.insert(key.to_owned(), value);
            }
        }
        Value::Number(number) if rng.u8(..3) > 0 => {
            let near = number.as_f64().unwrap_or_default() + pick(rng, &[-1.0, 1.0, 2.0, 0.001]);
            *value = if near.fract() == 0.0 { json!(near as i64) } else { json!(near) };
        }
        _ if rng.u8(..4) == 0 => *value = other,
        _ => *value = pick(rng, &odd()),
    }
}

fn list_places(value: &Value, place: String, places: &mut Vec<String>) {
    match value {
        Value::Array(list) => {
            for (index, item) in list.iter().enumerate() {
                list_places(item, format!("{place}/{index}"), places);
            }
        }
        Value::Object(fields) => {
            for (key, item) in fields {
                list_places(item, format!("{place}/{}", key.replace('/', "~1")), places);
            }
        }
        _ => {}
    }
    places.push(place);
}

fn odd() -> Vec<Value> {
    let numbers = [json!(0), json!(-1), json!(1), json!(255), json!(65535), json!(u32::MAX)];
    let large = [json!(1u64 << 32), json!(u64::MAX), json!(i64::MIN), json!(1e38), json!(1e-40)];
    let others =
        [json!(0.5), json!(1e300), json!(null), json!(""), json!("x"), json!([]), json!({})];
    let names =
        [json!("VEC2"), json!("SCALAR"), json!("MAT4"), json!(5120), json!(5126), json!(true)];
    [&numbers[..], &large, &others, &names].concat()
}

/// Keys of glTF with values that may be wrong wherever they go.
fn foreign() -> Vec<(&'static str, Value)> {
    let compressed =
        json!({"buffer": 0, "byteLength": 4, "byteStride": 4, "count": 1, "mode": "X"});
    vec![
        ("byteStride", json!(4)),
        ("byteOffset", json!(2)),
        ("normalized", json!(true)),
        ("mode", json!(5)),
        ("mode", json!(6)),
        ("mode", json!(0)),
        ("indices", json!(0)),
        ("children", json!([0])),
        ("skin", json!(0)),
        ("scene", json!(0)),
        ("targets", json!([{"POSITION": 0}])),
        ("matrix", json!([0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0])),
        ("scale", json!([0, 0, 0])),
        ("scale", json!([1, -1, 1e-9])),
        ("rotation", json!([0, 0, 0, 0])),
        ("translation", json!([1e9, 0, 0])),
        ("doubleSided", json!(true)),
        ("extensionsRequired", json!(["KHR_draco_mesh_compression"])),
        ("extensionsUsed", json!(["KHR_mesh_quantization", "EXT_meshopt_compression"])),
        ("extensions", json!({"EXT_meshopt_compression": compressed})),
        ("extensions", json!({"KHR_texture_basisu": {"source": 0}})),
        ("extensions", json!({"KHR_texture_transform": {"scale": [1e30, 0], "rotation": 1e30}})),
        (
            "sparse",
            json!({"count": 1, "indices": {"bufferView": 0, "componentType": 5121},
            "values": {"bufferView": 0}}),
        ),
        ("uri", json!("data:;base64,AAAA")),
        ("uri", json!("%ff")),
    ]
}
