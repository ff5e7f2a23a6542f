//! Why a session ends early.

/// Why a session ended early.
#[derive(Debug, thiserror::Error)]
pub enum LspError {
    /// The client does not speak the protocol.
    #[error(
        "the editor does not speak the language server protocol: {0}; start the server from one"
    )]
    Protocol(#[from] lsp_server::ProtocolError),
    /// The client has closed the connection.
    #[error("the editor has closed the connection")]
    Closed,
    /// Standard input or output failed.
    #[error("standard input or output failed: {0}")]
    Io(#[from] std::io::Error),
}
