//! Where rows come from: a finished log, standard input, a file that is being written, a socket.

use super::super::input;
use crate::{error::CommandError, interrupt, terminal};
use fluxfit::log::Row;
use fluxfit_files::{FileError, input as files};
use fluxfit_log::{LiveLog, LogOptions, read_log_with_progress};
use std::{
    fs::{self, File},
    io::{Read, Seek},
    net::TcpListener,
    path::{Path, PathBuf},
    sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel},
    thread,
    time::Duration,
};

/// Takes rows; false if no more are wanted.
pub(super) type Take<'a> = dyn FnMut(&Row) -> Result<bool, CommandError> + 'a;

/// Time after which a file that has not grown is looked at again: half of the 10 ms within which a row is told.
const LOOK: Duration = Duration::from_millis(5);

/// Time after which it is noticed that Ctrl-C was pressed.
const INTERRUPT: Duration = Duration::from_millis(100);

/// Bytes that are read at a time.
const PIECE: usize = 1 << 16;

/// Pieces that may wait.
const WAITING: usize = 16;

/// Most bytes of one line.
const LONGEST_LINE: usize = 1 << 20;

/// What a reading thread sends.
enum Message {
    Bytes(Vec<u8>),
    /// The text begins anew, with a header, for this reason.
    Anew(String),
    Failed(std::io::Error),
}

/// Reads a finished log of any format.
pub(super) fn file(path: &Path, options: &LogOptions, take: &mut Take) -> Result<(), CommandError> {
    let progress = terminal::reading(&format!("reading {}", input::name(path)), fs::metadata(path).map_or(0, |metadata| metadata.len()));
    let read = read_log_with_progress(path, &LogOptions { all_rows: true, ..options.clone() }, progress.teller())?;
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
pub(super) fn stream(path: &Path, follows: bool, options: &LogOptions, take: &mut Take) -> Result<(), CommandError> {
    let name = input::name(path);
    let receiver = if files::is_standard(path) {
        reading(|sender| {
            if let Err(error) = pass_on(&mut std::io::stdin().lock(), &sender) {
                let _ = sender.send(Message::Failed(error));
            }
        })?
    } else {
        let of_file = |error: &std::io::Error| FileError::from(files::io_problem("reading", error)).in_file(&name);
        let file = File::open(path).map_err(|error| of_file(&error))?;
        let path = path.to_owned();
        reading(move |sender| if follows { follow(&path, file, &sender) } else { drop(sender) })?
    };
    lines(&name, receiver, options, take)
}

/// Waits for connections, one after the other, and reads lines from each.
pub(super) fn listen(place: &str, options: &LogOptions, take: &mut Take) -> Result<(), CommandError> {
    let cannot =
        |error: std::io::Error| CommandError::Usage(format!("{place} cannot be listened on: {error}; write HOST:PORT of this machine"));
    let listener = TcpListener::bind(place).map_err(cannot)?;
    if let Ok(address) = listener.local_addr() {
        terminal::note(&format!("listening on {address}"));
    }
    let receiver = reading(move |sender| {
        for connection in listener.incoming() {
            if sender.send(of_connection(connection, &sender)).is_err() {
                return;
            }
        }
    })?;
    lines(place, receiver, options, take)
}

fn reading(read: impl FnOnce(SyncSender<Message>) + Send + 'static) -> Result<Receiver<Message>, CommandError> {
    let (sender, receiver) = sync_channel(WAITING);
    thread::Builder::new().name("reading".to_owned()).spawn(move || read(sender))?;
    Ok(receiver)
}

/// Passes on what a connection brings. At its end, however it ended: what is told of it, and that the next one begins anew.
fn of_connection(connection: std::io::Result<impl Read>, sender: &SyncSender<Message>) -> Message {
    Message::Anew(match connection.and_then(|mut connection| pass_on(&mut connection, sender)) {
        Ok(()) => "the connection was closed; waiting for the next".to_owned(),
        Err(error) => format!("a connection failed: {error}; waiting for the next"),
    })
}

/// Passes bytes on as they arrive, to the end.
fn pass_on(reader: &mut dyn Read, sender: &SyncSender<Message>) -> std::io::Result<()> {
    loop {
        let mut piece = vec![0; PIECE];
        match reader.read(&mut piece) {
            Ok(0) => return Ok(()),
            Ok(count) => piece.truncate(count),
            Err(error) if error.kind() == std::io::ErrorKind::Interrupted => continue,
            Err(error) => return Err(error),
        }
        if sender.send(Message::Bytes(piece)).is_err() {
            return Ok(());
        }
    }
}

/// Follows a file that grows, is truncated or is replaced, until nobody listens any more.
fn follow(path: &PathBuf, mut file: File, sender: &SyncSender<Message>) {
    let mut read = 0_u64;
    loop {
        let mut piece = vec![0; PIECE];
        match file.read(&mut piece) {
            Ok(0) => thread::sleep(LOOK),
            Ok(count) => {
                read += count as u64;
                piece.truncate(count);
                if sender.send(Message::Bytes(piece)).is_err() {
                    return;
                }
                continue;
            }
            Err(error) => {
                let _ = sender.send(Message::Failed(error));
                return;
            }
        }
        let reason = match fs::metadata(path) {
            // It is being replaced: look again.
            Err(_) => continue,
            Ok(now) if !is_same(&file, &now) => "the file was replaced; going on with the new one",
            Ok(now) if now.len() < read => "the file was truncated; going on from its beginning",
            Ok(_) => continue,
        };
        // What the old file got since it was last read is read first.
        if reason.starts_with("the file was replaced") {
            let mut rest = Vec::new();
            if file.read_to_end(&mut rest).is_ok() && !rest.is_empty() && sender.send(Message::Bytes(rest)).is_err() {
                return;
            }
            match File::open(path) {
                Ok(new) => file = new,
                Err(_) => continue,
            }
        }
        read = 0;
        if file.rewind().is_err() || sender.send(Message::Anew(reason.to_owned())).is_err() {
            return;
        }
    }
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
fn lines(name: &str, receiver: Receiver<Message>, options: &LogOptions, take: &mut Take) -> Result<(), CommandError> {
    interrupt::doing("tracking");
    interrupt::be_gentle(true);
    let mut text = Text { name, options, log: None, head: String::new(), rest: Vec::new() };
    let mut has_rows = false;
    loop {
        let goes_on = match receiver.recv_timeout(INTERRUPT) {
            Ok(Message::Bytes(bytes)) => text.take(&bytes, take, &mut has_rows)?,
            Ok(Message::Anew(reason)) => {
                terminal::note(&format!("{name}: {reason}"));
                text.end(take, &mut has_rows)?;
                (text.log, text.head) = (None, String::new());
                true
            }
            Ok(Message::Failed(error)) => return Err(FileError::from(files::io_problem("reading", &error)).in_file(name).into()),
            Err(RecvTimeoutError::Timeout) => true,
            Err(RecvTimeoutError::Disconnected) => {
                text.end(take, &mut has_rows)?;
                false
            }
        };
        if !goes_on || interrupt::go_on().is_break() {
            break;
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
        for end in bytes.iter().enumerate().filter(|(_, byte)| **byte == b'\n').map(|(at, _)| at + 1) {
            let piece = &bytes[begin..end];
            begin = end;
            let goes_on = if self.rest.is_empty() {
                self.line(&String::from_utf8_lossy(piece), take, has_rows)?
            } else {
                let mut line = std::mem::take(&mut self.rest);
                line.extend_from_slice(piece);
                let goes_on = self.line(&String::from_utf8_lossy(&line), take, has_rows)?;
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

    /// The last line may lack its end.
    fn end(&mut self, take: &mut Take, has_rows: &mut bool) -> Result<(), CommandError> {
        if !self.rest.is_empty() {
            let mut line = String::from_utf8_lossy(&std::mem::take(&mut self.rest)).into_owned();
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::{Error, ErrorKind};

    /// A connection that brings a row and is then reset by the peer.
    struct Reset(Option<&'static [u8]>);

    impl Read for Reset {
        fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
            let row = self.0.take().ok_or(Error::from(ErrorKind::ConnectionReset))?;
            buffer[..row.len()].copy_from_slice(row);
            Ok(row.len())
        }
    }

    #[test]
    fn after_a_connection_that_was_reset_the_next_one_is_waited_for() {
        let (sender, receiver) = sync_channel(WAITING);
        let last = of_connection(Ok(Reset(Some(b"0.1,2\n"))), &sender);
        assert!(matches!(receiver.try_recv(), Ok(Message::Bytes(bytes)) if bytes == b"0.1,2\n"));
        assert!(receiver.try_recv().is_err());
        assert!(
            matches!(last, Message::Anew(reason) if reason.starts_with("a connection failed") && reason.ends_with("waiting for the next"))
        );
    }
}
