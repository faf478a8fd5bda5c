//! Trajectories as GSD files, which OVITO and HOOMD-blue read.
//!
//! Version 2.0 of the format (gsd.readthedocs.io/en/stable/file-layer.html), schema `hoomd` 1.4: a
//! header of 256 bytes; the chunks of data; an index with an entry of 32 bytes for each chunk, by
//! frame and name; and the list of names. All numbers are little-endian. Lengths are in m, masses
//! in kg, times in steps of a frame; places are of centres of mass, as HOOMD-blue has them; quaternions rotate tiles about the z axis.

/// The first bytes of every file.
const MAGIC: u64 = 0x65DF_65DF_65DF_65DF;
/// 2.0, and 1.4 of the schema.
const VERSIONS: [u32; 2] = [(1 << 16) | 4, 2 << 16];
const HEADER: usize = 256;
/// Bytes of a name in the list.
const NAME: usize = 64;

/// The type of a chunk's numbers.
#[derive(Clone, Copy)]
enum NumberType {
    U8 = 1,
    U32 = 3,
    U64 = 4,
    F32 = 9,
}

/// An outline as a polygon (m) about the centre of mass.
pub type Polygon = Vec<[f64; 2]>;

/// A tile in a frame.
#[derive(Clone, Copy, Debug)]
pub struct Particle {
    /// Its centre of mass (m).
    pub place: [f64; 2],
    /// Its orientation (rad).
    pub theta: f64,
    /// Its velocity (m/s, m/s) and angular velocity (rad/s).
    pub velocity: [f64; 3],
    /// The index of its kind.
    pub kind: usize,
    /// Its mass (kg).
    pub mass: f64,
    /// Its moment of inertia (kg m^2).
    pub inertia: f64,
}

/// A file's bytes: kinds of tiles with their outlines, the table's size (m), and frames.
pub fn file(kinds: &[(String, Polygon)], table: [f64; 2], frames: &[Vec<Particle>]) -> Vec<u8> {
    let mut writer = Writer::default();
    for (number, particles) in frames.iter().enumerate() {
        writer.frame = number as u64;
        let count = particles.len();
        writer.chunk(
            "configuration/step",
            NumberType::U64,
            [1, 1],
            bytes(&[number as u64], |x| x.to_le_bytes()),
        );
        if number == 0 {
            writer.chunk("configuration/dimensions", NumberType::U8, [1, 1], vec![2]);
            let size = [table[0], table[1], 0.0, 0.0, 0.0, 0.0];
            writer.floats("configuration/box", [6, 1], size);
            let whole = bytes(&[count as u32], |x| x.to_le_bytes());
            writer.chunk("particles/N", NumberType::U32, [1, 1], whole);
            let names: Vec<&str> = kinds.iter().map(|kind| kind.0.as_str()).collect();
            writer.texts("particles/types", &names);
            let shapes: Vec<String> = kinds.iter().map(|kind| shape(&kind.1)).collect();
            let shapes: Vec<&str> = shapes.iter().map(String::as_str).collect();
            writer.texts("particles/type_shapes", &shapes);
            let of_kind: Vec<u32> = particles.iter().map(|it| it.kind as u32).collect();
            let of_kind = bytes(&of_kind, |x| x.to_le_bytes());
            writer.chunk("particles/typeid", NumberType::U32, [count, 1], of_kind);
            writer.floats(
                "particles/mass",
                [count, 1],
                particles.iter().map(|it| it.mass),
            );
            let inertia = particles.iter().flat_map(|it| [0.0, 0.0, it.inertia]);
            writer.floats("particles/moment_inertia", [count, 3], inertia);
        }
        let place = particles
            .iter()
            .flat_map(|it| [it.place[0], it.place[1], 0.0]);
        writer.floats("particles/position", [count, 3], place);
        let turn = particles.iter().flat_map(|it| {
            let half = 0.5 * it.theta;
            [libm::cos(half), 0.0, 0.0, libm::sin(half)]
        });
        writer.floats("particles/orientation", [count, 4], turn);
        let velocity = particles
            .iter()
            .flat_map(|it| [it.velocity[0], it.velocity[1], 0.0]);
        writer.floats("particles/velocity", [count, 3], velocity);
        // The angular momentum in HOOMD's form: 2 q (0, I w).
        let momentum = particles.iter().flat_map(|it| {
            let half = 0.5 * it.theta;
            let twice = 2.0 * it.inertia * it.velocity[2];
            [-twice * libm::sin(half), 0.0, 0.0, twice * libm::cos(half)]
        });
        writer.floats("particles/angmom", [count, 4], momentum);
    }
    writer.finish()
}

/// A polygon as OVITO reads it.
fn shape(polygon: &Polygon) -> String {
    let value = serde_json::json!({
        "type": "Polygon", "rounding_radius": 0.0, "vertices": polygon,
    });
    value.to_string()
}

fn bytes<T, const N: usize>(values: &[T], of: impl Fn(&T) -> [u8; N]) -> Vec<u8> {
    values.iter().flat_map(of).collect()
}

/// A chunk's entry in the index.
struct Entry {
    frame: u64,
    rows: u64,
    location: u64,
    columns: u32,
    name: u16,
    kind: u8,
}

#[derive(Default)]
struct Writer {
    names: Vec<&'static str>,
    index: Vec<Entry>,
    data: Vec<u8>,
    frame: u64,
}

impl Writer {
    fn chunk(
        &mut self,
        name: &'static str,
        kind: NumberType,
        [rows, columns]: [usize; 2],
        bytes: Vec<u8>,
    ) {
        let known = self.names.iter().position(|it| *it == name);
        let number = known.unwrap_or_else(|| {
            self.names.push(name);
            self.names.len() - 1
        });
        self.index.push(Entry {
            frame: self.frame,
            rows: rows as u64,
            location: (HEADER + self.data.len()) as u64,
            columns: columns as u32,
            name: number as u16,
            kind: kind as u8,
        });
        self.data.extend(bytes);
    }

    fn floats(
        &mut self,
        name: &'static str,
        size: [usize; 2],
        values: impl IntoIterator<Item = f64>,
    ) {
        let bytes = values.into_iter().flat_map(|x| (x as f32).to_le_bytes());
        self.chunk(name, NumberType::F32, size, bytes.collect());
    }

    /// Texts as rows of zero-terminated bytes.
    fn texts(&mut self, name: &'static str, texts: &[&str]) {
        let longest = texts.iter().map(|text| text.len()).max().unwrap_or(0) + 1;
        let mut bytes = Vec::new();
        for text in texts {
            bytes.extend(text.as_bytes());
            bytes.resize(bytes.len().next_multiple_of(longest), 0);
            if text.is_empty() {
                bytes.resize(bytes.len() + longest, 0);
            }
        }
        self.chunk(name, NumberType::U8, [texts.len(), longest], bytes);
    }

    fn finish(mut self) -> Vec<u8> {
        self.index.sort_by_key(|entry| (entry.frame, entry.name));
        let index_at = (HEADER + self.data.len()) as u64;
        // One entry more, all zero, ends the index.
        let entries = self.index.len() as u64 + 1;
        let names_at = index_at + 32 * entries;
        let places = self.names.len() as u64 + 1;
        let mut file = Vec::with_capacity(HEADER + self.data.len() + 32 * entries as usize);
        for number in [MAGIC, index_at, entries, names_at, places] {
            file.extend(number.to_le_bytes());
        }
        for version in VERSIONS {
            file.extend(version.to_le_bytes());
        }
        for (text, end) in [("tilebind", 48 + 64), ("hoomd", 48 + 128)] {
            file.extend(text.as_bytes());
            file.resize(end, 0);
        }
        file.resize(HEADER, 0);
        file.extend(&self.data);
        for entry in &self.index {
            for number in [entry.frame, entry.rows, entry.location] {
                file.extend(number.to_le_bytes());
            }
            file.extend(entry.columns.to_le_bytes());
            file.extend(entry.name.to_le_bytes());
            file.extend([entry.kind, 0]);
        }
        file.resize(names_at as usize, 0);
        for name in &self.names {
            file.extend(name.as_bytes());
            file.push(0);
        }
        file.resize(names_at as usize + NAME * places as usize, 0);
        file
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn number(bytes: &[u8], at: usize) -> u64 {
        u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap())
    }

    #[test]
    fn chunks_lie_where_the_index_says() {
        let square = vec![[-0.1, -0.1], [0.1, -0.1], [0.1, 0.1], [-0.1, 0.1]];
        let kinds = [
            ("fixed".to_owned(), square.clone()),
            ("b".to_owned(), square),
        ];
        let tile = |kind: usize, x: f64| Particle {
            place: [x, 0.5],
            theta: std::f64::consts::PI,
            velocity: [0.0; 3],
            kind,
            mass: 0.25,
            inertia: 0.5,
        };
        let frames = vec![
            vec![tile(0, 1.0), tile(1, 2.0)],
            vec![tile(0, 3.0), tile(1, 4.0)],
        ];
        let bytes = file(&kinds, [2.0, 3.0], &frames);
        assert_eq!(number(&bytes, 0), MAGIC);
        let (index, entries) = (number(&bytes, 8) as usize, number(&bytes, 16) as usize);
        let names = number(&bytes, 24) as usize;
        assert_eq!(names, index + 32 * entries);
        let list = &bytes[names..];
        let names: Vec<&str> = list
            .split(|byte| *byte == 0)
            .take_while(|name| !name.is_empty())
            .map(|name| std::str::from_utf8(name).unwrap())
            .collect();
        let places: Vec<f32> = (0..entries)
            .map(|k| &bytes[index + 32 * k..index + 32 * (k + 1)])
            .filter(|entry| number(entry, 16) > 0)
            .filter(|entry| {
                let name = u16::from_le_bytes(entry[28..30].try_into().unwrap());
                names[usize::from(name)] == "particles/position"
            })
            .flat_map(|entry| {
                let (rows, at) = (number(entry, 8) as usize, number(entry, 16) as usize);
                assert_eq!(rows, 2);
                bytes[at..at + 4 * 3 * rows].chunks(4)
            })
            .map(|four| f32::from_le_bytes(four.try_into().unwrap()))
            .collect();
        let expected = [1.0, 0.5, 0.0, 2.0, 0.5, 0.0, 3.0, 0.5, 0.0, 4.0, 0.5, 0.0];
        assert_eq!(places, expected);
    }
}
