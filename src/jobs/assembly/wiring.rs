//! Which faces bind which: the words that a tile set needs.
//!
//! On each axis the glues of east (north) faces bind those of west (south) faces. If each of some
//! glues on one side binds each of some glues on the other equally, they form one bond with one
//! word. A glue that binds nothing needs no word, and its faces stay empty. Glues that bind
//! themselves and, more weakly, each other have a word each; these words are equal in as many
//! places as the strength requires ([`Link`]): `NNNN` binds the mate of `NNNS` with half of its
//! bond.

use super::TileSet;
use super::axis::{MeetingAxis, Met, SIDES};
use physics::order::Order;

/// Glues that bind each other along an axis through one word.
#[derive(Clone, Debug, PartialEq)]
pub struct Bond {
    /// The axis.
    pub axis: MeetingAxis,
    /// In Gse.
    pub strength: f64,
    /// The glues of faces that carry the word, and of faces that carry its mate.
    pub glues: [Vec<usize>; 2],
}

/// Two bonds such that each one's word binds the other's mate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Link {
    /// The bonds, ascending.
    pub bonds: [usize; 2],
    /// In Gse.
    pub strength: f64,
}

/// Bonds connected by links, and the requirements of their words.
#[derive(Clone, Debug, PartialEq)]
pub struct LinkedBonds {
    /// The bonds, ascending.
    pub bonds: Vec<usize>,
    /// The strengths (in Gse) between each bond's word and each bond's mate; their own on the
    /// diagonal.
    pub strengths: Vec<Vec<f64>>,
}

/// All bonds of a tile set.
#[derive(Clone, Debug, PartialEq)]
pub struct Wiring {
    /// The bonds, by their first glue.
    pub bonds: Vec<Bond>,
    /// The links between bonds.
    pub links: Vec<Link>,
    /// The bonds by side and glue.
    by_face: [Vec<Option<usize>>; 4],
}

/// Two tiles that meet, the first in the west or south, by the bonds of their faces.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct TilePair {
    /// The axis along which they meet.
    pub axis: MeetingAxis,
    /// The bonds of all their faces.
    pub faces: [[Option<usize>; 4]; 2],
    /// The bond by which they meet.
    pub bond: usize,
}

impl Wiring {
    /// The strength (in Gse) of the weakest bond.
    pub fn least_strength(&self) -> f64 {
        let strengths = self.bonds.iter().map(|bond| bond.strength);
        strengths.fold(f64::INFINITY, f64::min)
    }

    /// The bonds of a set.
    ///
    /// # Errors
    /// If there are no bonds, or words cannot represent the glues.
    pub fn new(set: &TileSet) -> Result<Self, String> {
        let n = set.glues.len();
        let strengths = set.strengths();
        let mut wiring = Self {
            bonds: Vec::new(),
            links: Vec::new(),
            by_face: std::array::from_fn(|_| vec![None; n]),
        };
        for axis in MeetingAxis::ALL {
            let used = axis.sides().map(|side| {
                let used =
                    |glue: &usize| set.tiles.iter().any(|tile| tile.glues[side] == Some(*glue));
                (0..n).filter(used).collect::<Vec<usize>>()
            });
            let mut open = used.clone();
            while let Some(first) = open[0].first().copied() {
                let mut glues = [vec![first], Vec::new()];
                loop {
                    let before = glues.clone();
                    for (from, to) in [(0, 1), (1, 0)] {
                        let holds = |glue: &usize| {
                            let mut others = glues[from].iter();
                            others.any(|other| strengths[*other][*glue] > 0.0)
                        };
                        let is_new = |glue: &usize| !glues[to].contains(glue) && holds(glue);
                        let more: Vec<usize> = used[to].iter().copied().filter(is_new).collect();
                        glues[to].extend(more);
                    }
                    if glues == before {
                        break;
                    }
                }
                open[0].retain(|glue| !glues[0].contains(glue));
                if glues[1].is_empty() {
                    continue;
                }
                match each(axis, &glues, &strengths) {
                    Some(bonds) => wiring.bonds.extend(bonds),
                    None => wiring.bonds.push(bond(set, axis, glues, &strengths)?),
                }
            }
        }
        wiring
            .bonds
            .order_by_key(|bond| (bond.glues.iter().flatten().min().copied(), bond.axis));
        wiring.link(&strengths);
        for (number, bond) in wiring.bonds.iter().enumerate() {
            for (side, glues) in bond.axis.sides().into_iter().zip(&bond.glues) {
                for glue in glues {
                    wiring.by_face[side][*glue] = Some(number);
                }
            }
        }
        if wiring.bonds.is_empty() {
            return Err(
                "no two of its tiles bind: give its glues strengths, under `bonds` or as `binding \
                 strengths`"
                    .to_owned(),
            );
        }
        Ok(wiring)
    }

    fn link(&mut self, strengths: &[Vec<f64>]) {
        for (j, second) in self.bonds.iter().enumerate() {
            for (i, first) in self.bonds[..j].iter().enumerate() {
                let meet = |a: &Bond, b: &Bond| {
                    let pairs = a.glues[0]
                        .iter()
                        .flat_map(|g| b.glues[1].iter().map(move |h| (*g, *h)));
                    pairs.map(|(g, h)| strengths[g][h]).fold(0.0, f64::max)
                };
                let strength = f64::max(meet(first, second), meet(second, first));
                if first.axis == second.axis && strength > 0.0 {
                    self.links.push(Link {
                        bonds: [i, j],
                        strength,
                    });
                }
            }
        }
    }

    /// Whether the words of one bond and the mates of the other bind each other by intention; such
    /// contacts do not count as wrong.
    pub fn are_linked(&self, a: usize, b: usize) -> bool {
        let bonds = [a.min(b), a.max(b)];
        self.links.iter().any(|link| link.bonds == bonds)
    }

    /// The groups of bonds connected by links.
    pub fn groups(&self) -> Vec<LinkedBonds> {
        let mut groups: Vec<Vec<usize>> = Vec::new();
        for Link { bonds, .. } in &self.links {
            let (mut joined, others): (Vec<_>, Vec<_>) = groups
                .into_iter()
                .partition(|group| bonds.iter().any(|bond| group.contains(bond)));
            joined.push(bonds.to_vec());
            let mut one: Vec<usize> = joined.concat();
            one.sort_unstable();
            one.dedup();
            groups = others;
            groups.push(one);
        }
        let strength = |a: usize, b: usize| {
            let bonds = [a.min(b), a.max(b)];
            let link = self.links.iter().find(|link| link.bonds == bonds);
            match a == b {
                true => self.bonds[a].strength,
                false => link.map_or(0.0, |link| link.strength),
            }
        };
        let group = |bonds: Vec<usize>| LinkedBonds {
            strengths: bonds
                .iter()
                .map(|a| bonds.iter().map(|b| strength(*a, *b)).collect())
                .collect(),
            bonds,
        };
        groups.into_iter().map(group).collect()
    }

    /// The bond of a face of a tile, if the face is not empty.
    pub fn of(&self, set: &TileSet, tile: usize, side: usize) -> Option<usize> {
        self.by_face[side][set.tiles[tile].glues[side]?]
    }

    /// The meeting of two tiles, if they meet by a bond.
    pub fn meeting(&self, set: &TileSet, (first, axis, second): &Met) -> Option<TilePair> {
        let of = |tile: usize| std::array::from_fn(|side| self.of(set, tile, side));
        let faces: [[Option<usize>; 4]; 2] = [of(*first), of(*second)];
        let [out, back] = axis.sides();
        let bond = faces[0][out].filter(|bond| faces[1][back] == Some(*bond))?;
        Some(TilePair {
            axis: *axis,
            faces,
            bond,
        })
    }

    /// The number of words needed of each strength, strongest first.
    pub fn demand(&self) -> Vec<(f64, usize)> {
        let mut strengths: Vec<f64> = self.bonds.iter().map(|bond| bond.strength).collect();
        strengths.order_by(|a, b| b.total_cmp(a));
        let alike = strengths.chunk_by(|a, b| a == b);
        alike.map(|some| (some[0], some.len())).collect()
    }
}

/// One bond per glue for glues that do not all bind equally, if each binds itself and no other one
/// more strongly; otherwise `None`.
fn each(
    axis: MeetingAxis,
    [firsts, seconds]: &[Vec<usize>; 2],
    strengths: &[Vec<f64>],
) -> Option<Vec<Bond>> {
    let pairs = || firsts.iter().flat_map(|a| seconds.iter().map(|b| (*a, *b)));
    let mut all = pairs().map(|(a, b)| strengths[a][b]);
    let first = all.next()?;
    if all.all(|strength| strength == first) {
        return None;
    }
    let mut glues: Vec<usize> = [&firsts[..], seconds].concat();
    glues.sort_unstable();
    glues.dedup();
    let own = |glue: usize| strengths[glue][glue];
    let weaker = |(a, b): (usize, usize)| a == b || strengths[a][b] < f64::min(own(a), own(b));
    let holds = glues.iter().all(|glue| own(*glue) > 0.0) && pairs().all(weaker);
    let one = |glue: &usize| Bond {
        axis,
        strength: own(*glue),
        glues: [firsts, seconds].map(|side| {
            let own = side.iter().copied().filter(|it| it == glue);
            own.collect()
        }),
    };
    holds.then(|| glues.iter().map(one).collect())
}

fn bond(
    set: &TileSet,
    axis: MeetingAxis,
    mut glues: [Vec<usize>; 2],
    strengths: &[Vec<f64>],
) -> Result<Bond, String> {
    glues.iter_mut().for_each(|glues| glues.sort_unstable());
    let [firsts, seconds] = &glues;
    let pairs = || firsts.iter().flat_map(|a| seconds.iter().map(|b| (*a, *b)));
    let strength = pairs().map(|(a, b)| strengths[a][b]).fold(0.0, f64::max);
    if let Some((a, b)) = pairs().find(|(a, b)| strengths[*a][*b] != strength) {
        return Err(format!(
            "the glue `{}` of {} faces and `{}` of the faces they meet bind the same other glues, \
             but with different strengths ({} instead of {strength}): one word and its mate \
             cannot do that. Give them separate glues",
            set.glues[a].name,
            SIDES[axis.sides()[0]],
            set.glues[b].name,
            strengths[a][b]
        ));
    }
    Ok(Bond {
        axis,
        strength,
        glues,
    })
}
