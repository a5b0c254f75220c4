//! The methods: one file each, and the table of them.
//!
//! A new method is a file here, with its idea, equations, paper, settings and moves; its `pub mod`; and its row of the table below.

pub mod apso;
pub mod bfo;
pub mod cma_es;
pub mod cuckoo;
pub mod de;
pub mod fpa;
pub mod gwo;
pub mod hba;
pub mod igwo;
pub mod ipop_cma_es;
pub mod iso;
pub mod iwoa;
pub mod l_shade;
pub mod lpso;
pub mod msfpa;
pub mod nbfo;
pub mod particles;
pub mod so;
pub mod ssa;
pub mod ssa_cloud;
pub mod tgfpa;
pub mod tmfpa;
pub mod woa;

use crate::{
    error::Error,
    iteration::{Generation, Setup},
    look::Look,
    moves::Moves,
    population::Population,
};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};
use std::mem::discriminant;

/// A row of [`METHODS`]: all that other programs need to know of a method.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MethodFacts {
    /// Name in files and on the command line; serde's name of the variant too.
    pub key: &'static str,
    /// Name in prose.
    pub label: &'static str,
    /// The method with its default settings.
    pub default: Method,
    /// Smallest population that the method can work with.
    pub smallest_population: usize,
    /// How its curve looks.
    pub look: Look,
}

/// Makes [`Method`], [`METHODS`] and what each method does of the rows of the table.
macro_rules! table {
    ($($(#[$doc:meta])* $variant:ident($($path:ident)::+), $key:literal, $label:literal, $smallest:literal, $look:expr;)*) => {
        /// The methods, each with its settings.
        #[derive(Debug, Clone, Copy, PartialEq)]
        #[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
        #[cfg_attr(feature = "serde", serde(tag = "method", content = "settings", rename_all = "kebab-case"))]
        pub enum Method {
            $($(#[$doc])* $variant($($path)::+),)*
        }

        /// The table of methods; the paper's four come first, in the paper's order.
        pub const METHODS: &[MethodFacts] = &[$(MethodFacts {
            key: $key,
            label: $label,
            default: Method::$variant(<$($path)::+>::DEFAULT),
            smallest_population: $smallest,
            look: $look,
        },)*];

        /// A method under way: its settings, and what it remembers beside the [`Population`].
        #[derive(Debug, Clone)]
        #[cfg_attr(feature = "serde", derive(Serialize, Deserialize), serde(rename_all = "kebab-case"))]
        // One State per optimizer: its size does not matter.
        #[allow(clippy::large_enum_variant)]
        pub(crate) enum State {
            $($variant($($path)::+, <$($path)::+ as Moves>::Memory),)*
        }

        impl Method {
            /// The positions of its first candidates, row after row, and itself under way.
            pub(crate) fn start(self, setup: &mut Setup) -> Result<(Vec<f64>, State), Error> {
                match self {
                    $(Self::$variant(method) => {
                        method.check()?;
                        let (positions, memory) = Moves::start(&method, setup);
                        Ok((positions, State::$variant(method, memory)))
                    })*
                }
            }
        }

        impl State {
            /// Looks at the first candidates once they are evaluated.
            pub(crate) fn begin(&mut self, generation: &mut Generation) {
                match self {
                    $(Self::$variant(method, memory) => method.begin(memory, generation),)*
                }
            }

            /// Sets out the next trials.
            pub(crate) fn propose(&mut self, generation: &mut Generation) {
                match self {
                    $(Self::$variant(method, memory) => method.propose(memory, generation),)*
                }
            }

            /// Takes some of the evaluated trials.
            pub(crate) fn accept(&mut self, generation: &mut Generation) {
                match self {
                    $(Self::$variant(method, memory) => method.accept(memory, generation),)*
                }
            }

            /// Refuses settings out of range, of what was read back.
            #[cfg_attr(not(feature = "serde"), allow(dead_code))]
            pub(crate) fn check(&self) -> Result<(), Error> {
                match self {
                    $(Self::$variant(method, _) => method.check(),)*
                }
            }

            /// Whether a population that was read back is large enough, and what is remembered beside it has its size.
            #[cfg_attr(not(feature = "serde"), allow(dead_code))]
            pub(crate) fn fits(&self, population: &Population) -> bool {
                match self {
                    $(Self::$variant(_, memory) => population.len() >= $smallest && <$($path)::+ as Moves>::fits(memory, population),)*
                }
            }
        }
    };
}

// Documentation; variant and settings; key; label; smallest population; letter, colour of the terminal, light, dark, dashes.
#[rustfmt::skip]
table! {
    /// Flower pollination with t and Gaussian perturbation: the paper's algorithm.
    Tgfpa(tgfpa::Tgfpa), "tgfpa", "tGFPA", 4, look('t', 2, 0x00_5fe0, 0x6d_9bff, &[]);
    /// Flower pollination.
    Fpa(fpa::Fpa), "fpa", "FPA", 3, look('F', 3, 0x8f_5a00, 0xff_9a3d, &[75, 40]);
    /// Particle swarm, inertia weight falling linearly.
    Lpso(lpso::Lpso), "lpso", "LPSO", 1, look('L', 4, 0x14_4a38, 0x4d_f0bb, &[20, 30]);
    /// Particle swarm, inertia weight adapted to each particle's cost.
    Apso(apso::Apso), "apso", "APSO", 1, look('A', 5, 0xb5_128f, 0xb7_8fc0, &[100, 35, 20, 35]);
    /// Differential evolution, DE/rand/1/bin.
    De(de::De), "de", "DE/rand/1/bin", 4, look('D', 1, 0xb0_2a1e, 0xff_8a7a, &[60, 25]);
    /// Grey wolves.
    Gwo(gwo::Gwo), "gwo", "GWO", 3, look('G', 8, 0x4a_5560, 0xa9_b6c2, &[20, 20]);
    /// Whales.
    Woa(woa::Woa), "woa", "WOA", 1, look('W', 6, 0x00_6a7a, 0x3f_c4d8, &[120, 30]);
    /// Salps.
    Ssa(ssa::Ssa), "ssa", "SSA", 2, look('s', 11, 0x6f_6a00, 0xc9_c23a, &[40, 20, 10, 20]);
    /// Honey badgers.
    Hba(hba::Hba), "hba", "HBA", 1, look('H', 13, 0x7a_1fa2, 0xd4_8cf0, &[90, 20]);
    /// Cuckoos.
    Cuckoo(cuckoo::Cuckoo), "cuckoo", "cuckoo search", 1, look('K', 10, 0x3d_6b1f, 0x9a_d66e, &[15, 45]);
    /// Adaptation of the covariance matrix.
    CmaEs(cma_es::CmaEs), "cma-es", "CMA-ES", 1, look('C', 12, 0x2b_2f9e, 0xa3_a8ff, &[150, 40]);
    /// Differential evolution, its settings adapted to what succeeds, its population shrinking.
    LShade(l_shade::LShade), "l-shade", "L-SHADE", 1, look('S', 9, 0xd0_1050, 0xff_7aa8, &[45, 15]);
    /// CMA-ES, restarted with twice the samples.
    IpopCmaEs(ipop_cma_es::IpopCmaEs), "ipop-cma-es", "IPOP-CMA-ES", 1, look('I', 14, 0x00_7a5a, 0x2f_e0b0, &[70, 20, 20, 20]);
    /// Snakes.
    So(so::So), "so", "SO", 4, look('O', 208, 0xa0_4a00, 0xff_b46a, &[30, 60]);
    /// Foraging bacteria.
    Bfo(bfo::Bfo), "bfo", "BFO", 2, look('B', 94, 0x6b_3d2e, 0xd0_a090, &[25, 15, 25, 45]);
    /// Improved snakes, after \[10\], reconstructed.
    Iso(iso::Iso), "iso", "improved SO, after [10], reconstructed", 4, look('o', 130, 0x8a_3a5a, 0xe0_98b8, &[110, 20, 15, 20]);
    /// Bacteria in niches, after \[11\], reconstructed.
    Nbfo(nbfo::Nbfo), "nbfo", "niche BFO, after [11], reconstructed", 4, look('N', 58, 0x55_5a2a, 0xb8_c080, &[35, 35]);
    /// Salps in a normal cloud, after \[13\], reconstructed.
    SsaCloud(ssa_cloud::SsaCloud), "ssa-cloud", "SSA with a cloud, after [13], reconstructed", 2, look('c', 30, 0x1f_5f8a, 0x7cc0e8, &[55, 55]);
    /// Improved whales, after \[14\], reconstructed.
    Iwoa(iwoa::Iwoa), "iwoa", "improved WOA, after [14], reconstructed", 1, look('w', 37, 0x2f_6f6a, 0x80_c8c0, &[80, 15, 10, 15, 10, 15]);
    /// Improved grey wolves, after \[16\], reconstructed.
    Igwo(igwo::Igwo), "igwo", "improved GWO, after [16], reconstructed", 3, look('g', 245, 0x6a_5a70, 0xc0_b0c8, &[10, 30]);
    /// Flower pollination with t mutation, after \[22\], reconstructed.
    Tmfpa(tmfpa::Tmfpa), "tmfpa", "tMFPA, after [22], reconstructed", 5, look('T', 27, 0x0a_4fb5, 0x86_b0ff, &[200, 30]);
    /// Flower pollination with several strategies, after \[21\], reconstructed.
    Msfpa(msfpa::Msfpa), "msfpa", "multi-strategy FPA, after [21], reconstructed", 4, look('M', 99, 0x5b_3fc0, 0xb8_a0ff, &[130, 20, 30, 20]);
}

/// A [`Look`] with its colours as red, green and blue in one number.
const fn look(letter: char, terminal: u8, light: u32, dark: u32, dashes: &'static [u16]) -> Look {
    const fn rgb(colour: u32) -> [u8; 3] {
        let [_, red, green, blue] = colour.to_be_bytes();
        [red, green, blue]
    }
    Look { letter, terminal, light: rgb(light), dark: rgb(dark), dashes }
}

/// tGFPA with its default settings.
impl Default for Method {
    fn default() -> Self {
        Self::Tgfpa(tgfpa::Tgfpa::DEFAULT)
    }
}

impl Method {
    /// All of them with their default settings, in the order of the table.
    pub fn all() -> [Self; METHODS.len()] {
        std::array::from_fn(|k| METHODS[k].default)
    }

    /// The method of a [`key`](Self::key), with its default settings.
    pub fn named(key: &str) -> Option<Self> {
        METHODS.iter().find(|facts| facts.key == key).map(|facts| facts.default)
    }

    /// Its row of the table.
    pub fn facts(&self) -> &'static MethodFacts {
        let of_this = |facts: &&MethodFacts| discriminant(&facts.default) == discriminant(self);
        // Every method has its row (tested), so the first one never stands for another.
        METHODS.iter().find(of_this).unwrap_or(&METHODS[0])
    }

    /// Name in files and on the command line.
    pub fn key(&self) -> &'static str {
        self.facts().key
    }

    /// Name in prose.
    pub fn label(&self) -> &'static str {
        self.facts().label
    }

    /// Name where room is short: a star stands for "after \[n\], reconstructed".
    pub fn short_label(&self) -> String {
        match self.label().split_once(", after") {
            Some((name, _)) => format!("{name} *"),
            None => self.label().to_owned(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// serde lists all variants when it is asked for one that there is not.
    #[cfg(feature = "serde")]
    #[test]
    fn every_method_has_its_row_and_serdes_name_is_its_key() {
        let refusal = serde_json::from_str::<Method>(r#"{"method":"?"}"#).unwrap_err().to_string();
        let keys: Vec<&str> = METHODS.iter().map(|facts| facts.key).collect();
        let variants: Vec<&str> = refusal.split('`').skip(3).step_by(2).collect();
        assert_eq!(variants, keys, "{refusal}");
    }

    #[test]
    fn no_two_methods_share_what_tells_them_apart() {
        for (k, one) in METHODS.iter().enumerate() {
            assert_eq!(Method::named(one.key), Some(one.default));
            assert_eq!(one.default.facts(), one);
            for other in &METHODS[..k] {
                assert!(one.key != other.key && one.label != other.label, "{}", one.key);
                assert!(one.default.short_label() != other.default.short_label(), "{}", one.key);
                assert!(one.look.letter != other.look.letter, "{}", one.key);
                assert!(one.look.light != other.look.light && one.look.dark != other.look.dark, "{}", one.key);
            }
        }
        assert_eq!(Method::named("ga"), None);
    }

    #[test]
    fn a_star_marks_the_reconstructed_where_room_is_short() {
        let short = |key: &str| Method::named(key).map(|method| method.short_label());
        assert_eq!(short("iwoa").as_deref(), Some("improved WOA *"));
        assert_eq!(short("woa").as_deref(), Some("WOA"));
    }

    #[test]
    fn the_papers_methods_come_first() {
        let rows: Vec<(&str, usize)> = METHODS.iter().map(|facts| (facts.key, facts.smallest_population)).collect();
        assert_eq!(rows[..4], [("tgfpa", 4), ("fpa", 3), ("lpso", 1), ("apso", 1)]);
    }
}
