//! Ctrl-C: the first time the work ends in good order, the second time at once.

use crate::output::note;
use steradian::render::CancelToken;

/// A token that Ctrl-C cancels; `saying` is what the user is told then. To be called once per program.
pub(crate) fn token(saying: &'static str) -> CancelToken {
    let token = CancelToken::new();
    let cancel = token.clone();
    let handler = move || {
        if cancel.is_cancelled() {
            // The second time the user means it.
            std::process::exit(130);
        }
        cancel.cancel();
        note(saying);
    };
    // Without a handler Ctrl-C ends the program at once, as it does everywhere.
    if let Err(e) = ctrlc::set_handler(handler) {
        note(&format!("warning: Ctrl-C will not save what was done: {e}"));
    }
    token
}
