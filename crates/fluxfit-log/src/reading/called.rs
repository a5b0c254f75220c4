//! The channel of a name that stands alone, without the other columns of a table.

use super::alias::is_alias;
use crate::{block::ColumnHead, channel::Channel};

/// The channel that is usually called so; none where several are, or none.
pub(crate) fn channel_called(name: &str) -> Option<Channel> {
    let head = ColumnHead { name: name.to_owned(), ..ColumnHead::default() };
    let mut called = Channel::all().filter(|channel| is_alias(*channel, &head));
    called.next().filter(|_| called.next().is_none())
}
