//! Rows of equal tiles that bind with two faces each: open ones are chains, closed ones rings.
//!
//! A single tile is a chain of one. With kappa_1 the attachment rate (m^2/s) of a pair over the number
//! of its contacts that count as the bond, and S the area in which tiles meet:
//!
//! - **two chains join** by each pair of free ends that can bind at `f kappa_1 / S`, unless the tiles
//!   would overlap in their exact places (to a hundredth of a tile). Sectors that turn by 2 pi / 8
//!   therefore have no chain of nine;
//! - **a bond opens** at `f k`, k the detachment rate of a pair;
//! - **a chain closes** to a ring if its own ends can bind: at `2 pi kappa_1 p`, with p (1/(m^2 rad))
//!   the density of the pose of one end at that of the other. `1 / (2 pi p)` is the area in which one
//!   free end would be as near to another. Each bond of a ring opens at k.
//! - `f = ((1/i + 1/j) / 2)^a` slows the motion of two chains of i and j tiles: a = 1/2 for tiles in
//!   flight, whose relative speed is that of their reduced mass; 1 for overdamped motion with a drag in
//!   proportion to the mass.
//!
//! Each rate and its reverse are in detailed balance with independent bonds, where `kappa / k` is the
//! pair's constant and a closed ring has that constant times `2 pi p` over its open chain (the ring
//! closure of Jacobson and Stockmayer 1950, doi:10.1063/1.1747547). p follows from the play of each
//! bond at kT ([`Spreads`]): the sum of n - 1 bonds and the last one is taken as normal, which is right to
//! a factor of two for four bonds. p hardly matters: whatever it is, ends of a chain that meets itself
//! are far nearer to each other than to other tiles, and close at once. Traps hold two
//! chains, which take part in nothing else meanwhile. Not included: forces between tiles that are not
//! neighbours, traps on rings, and how chains hide their ends from each other.
//!
//! Compared with `tilebind table` (elastic, without friction, drag 20 /s, sectors that cover 10 % of a table
//! and bind with 19 kT; bonds after 60 s, 95 % intervals):
//!
//! | sectors of a ring of | tiles | here | on the table |
//! |---|---|---|---|
//! | 3 | 8 | 2.6 (1.9 to 3.4) | 2.3 (1.6 to 2.9) |
//! | 4 | 8 | 1.7 (1.2 to 2.2) | 1.9 (1.4 to 2.4) |
//! | 6 | 12 | 3.2 (2.2 to 4.3) | 3.9 (3.2 to 4.6) |
//!
//! Closed rings of three: 0.43 (0.24 to 0.67) here and 0.19 (0 to 0.55) on the table.

mod closing;
mod growth;
mod joints;

pub use closing::Spreads;
pub use growth::{Census, Growth};
pub use joints::{Joints, TileRow};
