//! Mutated files, given to the command: it never panics or hangs, and its exit status is 0, 1 or 2. And the time that files of 10 MB take.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout, reason = "a test may fail, and says what it did")]

use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Stdio},
    time::{Duration, Instant},
};

/// Files that are tried unless [`COUNT`] says how many: two minutes of processes.
const FILES: usize = 10_000;

/// The environment variable with another number of files; the first of them are the same.
const COUNT: &str = "FLUXFIT_MUTATED_FILES";

/// The environment variable with the number of files before the first, for runs in slices.
const BEFORE: &str = "FLUXFIT_MUTATED_BEFORE";

/// Of so many files one is identified; the others are inspected, which reads them too.
const ONE_IDENTIFIED: usize = 50;

/// Nothing of this size may take longer.
const LONGEST: Duration = Duration::from_secs(20);

/// Bytes of the longest seed.
const SEED: usize = 6000;

/// Pieces of the formats.
const PIECES: [&str; 24] = [
    "{",
    "}",
    "[",
    "]",
    "\"",
    "\\",
    ",",
    ";",
    "\t",
    "\n",
    "#",
    "(",
    ")",
    "NaN",
    "1e999",
    "-",
    "***End_of_Header***\n",
    "X_Value",
    "X_Columns\tMulti\n",
    "2016-02-12T10:31:00Z",
    "12/31/9999 23:59:59",
    "99999999999999999999",
    "\u{202e}",
    "\u{0}",
];

/// splitmix64.
struct Random(u64);

impl Random {
    fn next(&mut self) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 1) as usize
    }

    fn below(&mut self, end: usize) -> usize {
        self.next() % end.max(1)
    }
}

fn corpus() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../fluxfit-log/tests/corpus")
}

/// The beginnings of the corpus's files that are no containers: those of the readers of text.
fn seeds() -> Vec<Vec<u8>> {
    let is_text = |path: &PathBuf| {
        path.extension().is_some_and(|kind| ["json", "jsonl", "lvm", "log", "txt", "csv", "asc"].map(Into::into).contains(&kind.to_owned()))
    };
    let mut paths: Vec<PathBuf> = fs::read_dir(corpus().join("logs")).unwrap().map(|entry| entry.unwrap().path()).filter(is_text).collect();
    paths.sort();
    let read = |path: PathBuf| fs::read(path).map(|bytes| bytes[..bytes.len().min(SEED)].to_vec()).unwrap();
    paths.into_iter().map(read).collect()
}

fn mutate(random: &mut Random, seeds: &[Vec<u8>]) -> Vec<u8> {
    let mut bytes = seeds[random.below(seeds.len())].clone();
    for _ in 0..1 + random.below(4) {
        let at = random.below(bytes.len());
        let end = (at + 1 + random.below(60)).min(bytes.len());
        match random.below(7) {
            0 => bytes.truncate(at),
            1 => drop(bytes.drain(at..end)),
            2 => {
                let part = bytes[at..end].to_vec();
                bytes.splice(at..at, part);
            }
            3 => {
                let piece = PIECES[random.below(PIECES.len())].bytes();
                drop(bytes.splice(at..at, piece));
            }
            4 => {
                let other = &seeds[random.below(seeds.len())];
                let from = random.below(other.len());
                bytes.truncate(at);
                bytes.extend_from_slice(&other[from..]);
            }
            5 => {
                let value = random.below(256) as u8;
                bytes[at..end].fill(value);
            }
            _ if !bytes.is_empty() => bytes[at] ^= 1 << random.below(8),
            _ => {}
        }
        if bytes.is_empty() {
            bytes.push(b'{');
        }
    }
    bytes
}

/// Runs the command; its exit status, none after a signal, and what it said. It is ended after a while.
fn run(arguments: &[&str], out: &Path) -> (Option<i32>, Duration) {
    let begun = Instant::now();
    let err = fs::File::create(out).unwrap();
    let mut child =
        Command::new(env!("CARGO_BIN_EXE_fluxfit")).args(arguments).stdin(Stdio::null()).stdout(Stdio::null()).stderr(err).spawn().unwrap();
    loop {
        if let Some(status) = child.try_wait().unwrap() {
            return (status.code(), begun.elapsed());
        }
        if begun.elapsed() > LONGEST {
            child.kill().unwrap();
            return (None, begun.elapsed());
        }
        std::thread::sleep(Duration::from_micros(300));
    }
}

#[test]
fn mutated_files_are_read_or_refused() {
    let stated = |name: &str| std::env::var(name).ok().map(|count| count.parse().expect("a number of files"));
    let (files, before): (usize, usize) = (stated(COUNT).unwrap_or(FILES), stated(BEFORE).unwrap_or(0));
    let seeds = seeds();
    let folder = tempfile::tempdir().unwrap();
    let dbc = corpus().join("mappings/drive.dbc");
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let work = |thread: usize| {
        let (log, said) = (folder.path().join(format!("{thread}.log")), folder.path().join(format!("{thread}.txt")));
        let (log, dbc) = (log.to_str().unwrap(), dbc.to_str().unwrap());
        let mut counts = [0; 3];
        for number in (before + thread..before + files).step_by(threads) {
            let bytes = mutate(&mut Random(number as u64), &seeds);
            fs::write(log, &bytes).unwrap();
            let verb = if number % ONE_IDENTIFIED == 0 { "identify" } else { "inspect" };
            let (status, took) = run(&[verb, log, "--dbc", dbc, "--pole-pairs", "4"], &said);
            let words = fs::read_to_string(&said).unwrap_or_default();
            let fits = matches!(status, Some(0..=2)) && !words.contains("panicked") && (status != Some(2) || words.contains("error:"));
            if !fits {
                let kept = std::env::temp_dir().join(format!("fluxfit_mutated_{number}.log"));
                fs::write(&kept, &bytes).unwrap();
                panic!("{verb} {}: status {status:?} after {took:?}: {words}", kept.display());
            }
            counts[status.unwrap_or(0) as usize] += 1;
        }
        counts
    };
    let counts: Vec<[usize; 3]> = std::thread::scope(|scope| {
        (0..threads)
            .map(|thread| scope.spawn(move || work(thread)))
            .collect::<Vec<_>>()
            .into_iter()
            .map(|thread| thread.join().unwrap())
            .collect()
    });
    let sum = |status: usize| counts.iter().map(|count| count[status]).sum::<usize>();
    println!("{files} files: exit status 0 of {}, 1 of {}, 2 of {}", sum(0), sum(1), sum(2));
    assert!(sum(0) > files / 50, "hardly a file was read: the mutations are too many");
}

/// Bytes of the large files.
const LARGE: usize = 10_000_000;

/// Seconds that one may take: 2 as users have the program, more in a build that is made to find mistakes.
const SECONDS: f64 = if cfg!(debug_assertions) { 12.0 } else { 2.0 };

#[test]
fn ten_megabytes_take_two_seconds_in_every_format() {
    let folder = tempfile::tempdir().unwrap();
    let row = |k: usize| [1.5 + (k % 7) as f64, 20.0, -(k as f64 % 3.0), 3.25, 400.5].map(|value| value.to_string());
    let of = |name: &str, head: &str, line: &dyn Fn(usize) -> String, end: &str| {
        let mut text = head.to_owned();
        (0..)
            .take_while(|_| true)
            .try_for_each(|k| {
                text += &line(k);
                if text.len() < LARGE { Ok(()) } else { Err(()) }
            })
            .unwrap_err();
        let path = folder.path().join(name);
        fs::write(&path, text + end).unwrap();
        path
    };
    let json = |k: usize| {
        let [ud, uq, id, iq, omega] = row(k);
        format!("{{\"t\":{},\"ud\":{ud},\"uq\":{uq},\"id\":{id},\"iq\":{iq},\"omega_e\":{omega}}}", k as f64 * 1e-4)
    };
    let date = |k: usize| format!("2016-02-12T{:02}:{:02}:{:02}.{:04}", k / 36_000_000, k / 600_000 % 60, k / 10_000 % 60, k % 10_000);
    let names = "ud,uq,id,iq,omega_e";
    let lvm = "LabVIEW Measurement\t\nSeparator\tTab\nX_Columns\tOne\n***End_of_Header***\n\nChannels\t5\n***End_of_Header***\nX_Value\tud\tuq\tid\tiq\tomega_e\n";
    let files = [
        of("lines.jsonl", "", &|k| json(k) + "\n", ""),
        of("array.json", "[{}", &|k| format!(",{}", json(k)), "]"),
        of("dates.csv", &format!("time,{names}\n"), &|k| format!("{},{}\n", date(k), row(k).join(",")), ""),
        of("spaces.txt", &format!("t {}\n", names.replace(',', " ")), &|k| format!("  {}   {}\n", k as f64 * 1e-4, row(k).join("  ")), ""),
        of("semicolons.csv", &format!("%t,{names}\n"), &|k| format!("{},{};\n", k as f64 * 1e-4, row(k).join(",")), ""),
        of("one_x.lvm", lvm, &|k| format!("{}\t{}\n", k as f64 * 1e-4, row(k).join("\t")), ""),
        of("frames.log", "", &|k| format!("({:.6}) can0 {:03X}#{:016X}\n", 1e9 + k as f64 * 1e-4, 256 + k % 3, k * 7919), ""),
    ];
    let dbc = corpus().join("mappings/drive.dbc");
    for path in files {
        let (status, took) = run(
            &["identify", path.to_str().unwrap(), "--window", "-2:-1", "--dbc", dbc.to_str().unwrap()],
            &folder.path().join("said.txt"),
        );
        let words = fs::read_to_string(folder.path().join("said.txt")).unwrap();
        println!("{}: {took:.2?}, status {status:?}", path.file_name().unwrap().display());
        // The window holds no row, so the log is read and nothing is identified.
        assert!(status == Some(2) && !words.contains("panicked"), "{status:?} {words}");
        assert!(took.as_secs_f64() < SECONDS, "{}: {took:?}", path.display());
    }
}
