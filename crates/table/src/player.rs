//! The C files that play a table; their sources are in `c/`.

/// Name and text of each file of the player. They belong beside the generated header. Only an
/// inverse table needs `carrystep_sine.*`.
pub const PLAYER: [(&str, &str); 4] = [
    ("carrystep_player.h", include_str!("../c/carrystep_player.h")),
    ("carrystep_player.c", include_str!("../c/carrystep_player.c")),
    ("carrystep_sine.h", include_str!("../c/carrystep_sine.h")),
    ("carrystep_sine.c", include_str!("../c/carrystep_sine.c")),
];
