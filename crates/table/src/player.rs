//! The C files that play a table.

/// Name and text of each file of the player; they go beside the header. `carrystep_sine.*` is needed only
/// for an inverse table.
pub const PLAYER: [(&str, &str); 4] = [
    ("carrystep_player.h", include_str!("../c/carrystep_player.h")),
    ("carrystep_player.c", include_str!("../c/carrystep_player.c")),
    ("carrystep_sine.h", include_str!("../c/carrystep_sine.h")),
    ("carrystep_sine.c", include_str!("../c/carrystep_sine.c")),
];
