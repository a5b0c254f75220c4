//! Where rows come from: a finished log, standard input, a file that is being written, a socket.

use super::super::{input, not_a_log};
use crate::{error::CommandError, interrupt, terminal};
use fluxfit::log::Row;
use fluxfit_files::{FileError, input as files};
use fluxfit_log::{LiveLog, LogOptions, read_log_with_progress};
use std::{
    borrow::Cow,
    fs::{self, File},
    io::{Read, Seek},
    net::{TcpListener, TcpStream},
    path::Path,
    thread,
    time::Duration,
};

/// Takes rows; false if no more are wanted.
pub(super) type Take<'a> = dyn FnMut(&Row) -> Result<bool, CommandError> + 'a;

/// Time after which a source that had little to read is looked at again: half of the 10 ms within which a row is told. A drive sends its
/// rows one by one, and waking up for each of them takes more of a core than the estimators.
const LOOK: Duration = Duration::from_millis(5);

/// Longest time until it is noticed that Ctrl-C was pressed.
const INTERRUPT: Duration = Duration::from_millis(100);

/// Bytes that are read at a time.
const PIECE: usize = 1 << 16;

/// Fewer bytes than this are little: a pipe holds no more than a piece, and whoever fills it faster than that is not waited for.
const LITTLE: usize = PIECE / 4;

/// Most bytes of one line.
const LONGEST_LINE: usize = 1 << 20;

/// Reads a finished log of any format.
pub(super) fn file(path: &Path, options: &LogOptions, take: &mut Take) -> Result<(), CommandError> {
    let progress = terminal::reading(&format!("reading {}", input::name(path)), fs::metadata(path).map_or(0, |metadata| metadata.len()));
    let read = read_log_with_progress(path, &LogOptions { all_rows: true, ..options.clone() }, progress.teller());
    let read = not_a_log::or_what_it_is(read, path)?;
    drop(progress);
    read.notes.iter().for_each(|note| terminal::note(&terminal::advice::with_options(&note.sentence, &note.advice)));
    if read.log.is_interpolated() {
        terminal::warn_of(
            "interpolated",
            "the channels of this log were sampled at different instants; what is told of it may be wrong: use fluxfit identify",
        );
    }
    let columns = read.log.columns();
    interrupt::doing("tracking");
    interrupt::be_gentle(true);
    for row in (0..columns.t.len()).filter_map(|k| columns.row(k)) {
        if !take(&row)? {
            break;
        }
    }
    interrupt::be_gentle(false);
    Ok(())
}

/// Reads standard input or a file that is being written, line by line.
pub(super) fn stream(path: &Path, options: &LogOptions, take: &mut Take) -> Result<(), CommandError> {
    let name = input::name(path);
    if files::is_standard(path) {
        let mut input = std::io::stdin().lock();
        return lines(&name, &mut |piece| next_of(&mut input, piece), options, take);
    }
    let mut file = File::open(path).map_err(|error| FileError::from(files::io_problem("reading", &error)).in_file(&name))?;
    let mut read = 0;
    lines(&name, &mut |piece| next_of_file(path, &mut file, &mut read, piece), options, take)
}

/// Waits for connections, one after the other, and reads lines from each.
pub(super) fn listen(place: &str, options: &LogOptions, take: &mut Take) -> Result<(), CommandError> {
    let cannot =
        |error: std::io::Error| CommandError::Usage(format!("{place} cannot be listened on: {error}; write HOST:PORT of this machine"));
    let listener = TcpListener::bind(place).map_err(cannot)?;
    if let Ok(address) = listener.local_addr() {
        terminal::note(&format!("listening on {address}"));
    }
    let mut connection = None;
    lines(place, &mut |piece| Ok(next_of_connections(&listener, &mut connection, piece)), options, take)
}

/// What a source brings next.
enum Next {
    /// So many bytes.
    Bytes(usize),
    /// Nothing yet.
    Nothing,
    /// The text begins anew, with a header, for this reason.
    Anew(String),
    End,
}

/// Brings the next bytes, without waiting much longer than [`INTERRUPT`].
type Bring<'a> = dyn FnMut(&mut [u8]) -> std::io::Result<Next> + 'a;

/// Whether there is something to read, or an end or an error, within [`INTERRUPT`].
#[cfg(unix)]
fn is_ready(source: &impl std::os::fd::AsFd) -> std::io::Result<bool> {
    use rustix::event::{PollFd, PollFlags, Timespec, poll};
    let patience = Timespec { tv_sec: 0, tv_nsec: INTERRUPT.subsec_nanos().into() };
    match poll(&mut [PollFd::new(source, PollFlags::IN)], Some(&patience)) {
        Ok(ready) => Ok(ready > 0),
        Err(rustix::io::Errno::INTR) => Ok(false),
        Err(error) => Err(error.into()),
    }
}

/// Where nothing tells, reading waits, and Ctrl-C is noticed with the next row.
#[cfg(not(unix))]
fn is_ready<T>(_: &T) -> std::io::Result<bool> {
    Ok(true)
}

#[cfg(unix)]
use std::os::fd::AsFd as Waited;

/// What can be waited for.
#[cfg(not(unix))]
trait Waited {}

#[cfg(not(unix))]
impl<T> Waited for T {}

fn next_of(source: &mut (impl Read + Waited), piece: &mut [u8]) -> std::io::Result<Next> {
    if !is_ready(source)? {
        return Ok(Next::Nothing);
    }
    match source.read(piece) {
        Ok(0) => Ok(Next::End),
        Ok(count) => Ok(Next::Bytes(count)),
        Err(error) if error.kind() == std::io::ErrorKind::Interrupted => Ok(Next::Nothing),
        Err(error) => Err(error),
    }
}

/// Of the connection there is, or of the next one.
fn next_of_connections(listener: &TcpListener, connection: &mut Option<TcpStream>, piece: &mut [u8]) -> Next {
    let next = match connection {
        Some(connection) => next_of(connection, piece),
        None => is_ready(listener).and_then(|is_ready| {
            if is_ready {
                *connection = Some(listener.accept()?.0);
            }
            Ok(Next::Nothing)
        }),
    };
    let next = of_connection(next);
    if matches!(next, Next::Anew(_)) {
        *connection = None;
    }
    next
}

/// At the end of a connection, however it ended: what is told of it, and that the next one begins anew.
fn of_connection(next: std::io::Result<Next>) -> Next {
    match next {
        Ok(Next::End) => Next::Anew("the connection was closed; waiting for the next".to_owned()),
        Ok(next) => next,
        Err(error) => Next::Anew(format!("a connection failed: {error}; waiting for the next")),
    }
}

/// Of a file that grows, is truncated or is replaced; `read` counts its bytes.
fn next_of_file(path: &Path, file: &mut File, read: &mut u64, piece: &mut [u8]) -> std::io::Result<Next> {
    // Asked for before the rest is read: what the old file got until it was replaced is read first.
    let now = fs::metadata(path);
    let count = file.read(piece)?;
    *read += count as u64;
    if count > 0 {
        return Ok(Next::Bytes(count));
    }
    let reason = match now {
        Ok(now) if !is_same(file, &now) => match File::open(path) {
            Ok(new) => {
                *file = new;
                "the file was replaced; going on with the new one"
            }
            Err(_) => return Ok(Next::Nothing),
        },
        Ok(now) if now.len() < *read => {
            file.rewind()?;
            "the file was truncated; going on from its beginning"
        }
        // It is being replaced, or has not grown: it is looked at again.
        _ => return Ok(Next::Nothing),
    };
    *read = 0;
    Ok(Next::Anew(reason.to_owned()))
}

/// Whether a path still leads to this file.
#[cfg(unix)]
fn is_same(file: &File, now: &fs::Metadata) -> bool {
    use std::os::unix::fs::MetadataExt;
    file.metadata().is_ok_and(|own| own.dev() == now.dev() && own.ino() == now.ino())
}

/// Whether a path still leads to this file: where a file that is open cannot be replaced, it does.
#[cfg(not(unix))]
fn is_same(_: &File, _: &fs::Metadata) -> bool {
    true
}

/// Makes rows of the bytes that arrive.
fn lines(name: &str, bring: &mut Bring, options: &LogOptions, take: &mut Take) -> Result<(), CommandError> {
    interrupt::doing("tracking");
    interrupt::be_gentle(true);
    let mut text = Text { name, options, log: None, head: String::new(), rest: Vec::new() };
    let mut has_rows = false;
    let mut piece = vec![0; PIECE];
    loop {
        let next = bring(&mut piece).map_err(|error| FileError::from(files::io_problem("reading", &error)).in_file(name))?;
        let is_little = match next {
            Next::Bytes(count) => {
                if !text.take(&piece[..count], take, &mut has_rows)? {
                    break;
                }
                count < LITTLE
            }
            Next::Nothing => true,
            Next::Anew(reason) => {
                terminal::note(&format!("{name}: {reason}"));
                text.break_off(take)?;
                false
            }
            Next::End => {
                text.end(take, &mut has_rows)?;
                break;
            }
        };
        if interrupt::go_on().is_break() {
            break;
        }
        if is_little {
            thread::sleep(LOOK);
        }
    }
    interrupt::be_gentle(false);
    if text.log.is_none() && !has_rows {
        // What is missing is said by whoever reads a whole log.
        fluxfit_log::parse_log(name, text.head.as_bytes(), options)?;
        return Err(CommandError::Usage(format!("{name}: there are too few rows to track anything; at least two are needed to begin")));
    }
    Ok(())
}

/// A text that arrives in pieces.
struct Text<'a> {
    name: &'a str,
    options: &'a LogOptions,
    log: Option<LiveLog>,
    /// The first lines, until the columns are recognized.
    head: String,
    /// The beginning of a line.
    rest: Vec<u8>,
}

impl Text<'_> {
    fn take(&mut self, bytes: &[u8], take: &mut Take, has_rows: &mut bool) -> Result<bool, CommandError> {
        let mut begin = 0;
        for end in memchr::memchr_iter(b'\n', bytes).map(|at| at + 1) {
            let piece = &bytes[begin..end];
            begin = end;
            let goes_on = if self.rest.is_empty() {
                self.line(&text_of(piece), take, has_rows)?
            } else {
                let mut line = std::mem::take(&mut self.rest);
                line.extend_from_slice(piece);
                let goes_on = self.line(&text_of(&line), take, has_rows)?;
                line.clear();
                self.rest = line;
                goes_on
            };
            if !goes_on {
                return Ok(false);
            }
        }
        // A line without an end must not fill the memory.
        if self.rest.len() < LONGEST_LINE {
            self.rest.extend_from_slice(&bytes[begin..]);
        }
        Ok(true)
    }

    /// The text begins anew: a line without an end was cut, and may look whole.
    fn break_off(&mut self, take: &mut Take) -> Result<(), CommandError> {
        if let Some(mut log) = self.log.take()
            && !self.rest.is_empty()
        {
            take(&log.cut_row())?;
        }
        self.head.clear();
        self.rest.clear();
        Ok(())
    }

    /// The last line may lack its end.
    fn end(&mut self, take: &mut Take, has_rows: &mut bool) -> Result<(), CommandError> {
        if !self.rest.is_empty() {
            let mut line = text_of(&std::mem::take(&mut self.rest)).into_owned();
            line.push('\n');
            self.line(&line, take, has_rows)?;
        }
        Ok(())
    }

    fn line(&mut self, line: &str, take: &mut Take, has_rows: &mut bool) -> Result<bool, CommandError> {
        let Some(log) = &mut self.log else {
            self.head.push_str(line);
            let Some((mut log, rows)) = LiveLog::open(self.name, &self.head, self.options)? else { return Ok(true) };
            if !*has_rows {
                log.notes.iter().for_each(|note| terminal::note(&terminal::advice::with_options(&note.sentence, &note.advice)));
                terminal::detail(|| log.described.clone());
            }
            *has_rows = true;
            self.head.clear();
            for line in rows.split_inclusive('\n') {
                if let Some(row) = log.row(line)
                    && !take(&row)?
                {
                    return Ok(false);
                }
            }
            self.log = Some(log);
            return Ok(true);
        };
        match log.row(line) {
            Some(row) => take(&row),
            None => Ok(true),
        }
    }
}

/// What is no UTF-8 becomes a mark, as in a log that is read whole. Valid text, nearly all of it, is only looked over.
fn text_of(bytes: &[u8]) -> Cow<'_, str> {
    std::str::from_utf8(bytes).map_or_else(|_| String::from_utf8_lossy(bytes), Cow::Borrowed)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::{Error, ErrorKind};

    #[test]
    fn after_a_connection_that_was_reset_the_next_one_is_waited_for() {
        let last = of_connection(Err(Error::from(ErrorKind::ConnectionReset)));
        assert!(
            matches!(last, Next::Anew(reason) if reason.starts_with("a connection failed") && reason.ends_with("waiting for the next"))
        );
        assert!(matches!(of_connection(Ok(Next::Bytes(3))), Next::Bytes(3)));
    }
}
