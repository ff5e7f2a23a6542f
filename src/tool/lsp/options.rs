//! What an editor may choose.

use gen_lsp_types::{LspNotificationMethod, MessageType, ShowMessageParams};
use lsp_server::{Message, Notification};
use serde::Deserialize;
use serde_json::{Value, json};

/// Options that an editor may send at the start of the server.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default)]
pub struct Options {
    /// The robot, by name or file.
    pub robot: Option<String>,
    /// The routine that starts the program.
    pub entry: Option<String>,
    /// Times of inputs, such as `diPart=2.5`.
    pub inputs: Vec<String>,
}

impl Options {
    /// These options, and those of `defaults` where nothing is given.
    pub(super) fn or(self, defaults: Options) -> Options {
        Options {
            robot: self.robot.or(defaults.robot),
            entry: self.entry.or(defaults.entry),
            inputs: if self.inputs.is_empty() { defaults.inputs } else { self.inputs },
        }
    }
}

/// The options in the parameters of `initialize`; with a warning to the user if they cannot be read.
pub(super) fn sent(params: &Value) -> (Options, Option<Message>) {
    let sent = params.get("initializationOptions").filter(|sent| !sent.is_null());
    match sent.map(Options::deserialize) {
        None => (Options::default(), None),
        Some(Ok(options)) => (options, None),
        Some(Err(error)) => (Options::default(), Some(warning(&error))),
    }
}

fn warning(error: &serde_json::Error) -> Message {
    let message = format!(
        "joulepath ignores the options of the editor (initializationOptions): {error}; they have \
         the form {{\"robot\": \"NAME\", \"entry\": \"PROCEDURE\", \"inputs\": [\"SIGNAL=SECONDS\"]}}"
    );
    Message::Notification(Notification {
        method: LspNotificationMethod::WindowShowMessage.to_string(),
        params: json!(ShowMessageParams { kind: MessageType::Warning, message }),
    })
}
