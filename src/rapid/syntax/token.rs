//! Token kinds, and the tokens of a file.

use std::ops::Range;

/// Declares the kinds with their names in messages; the keywords also as a table and as a look-up by
/// the packed word.
macro_rules! token_kinds {
    (
        kinds { $($(#[$doc:meta])* $kind:ident = $text:literal,)* }
        keywords { $($keyword:ident = $word:literal,)* }
        $(#[$end_doc:meta])* $end:ident = $end_text:literal,
    ) => {
        /// Kind of a token. The first two are trivia.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        #[repr(u8)]
        pub enum TokenKind {
            $($(#[$doc])* #[doc = concat!("In messages: ", $text)] $kind,)*
            $(#[doc = concat!("In messages: ", $word)] $keyword,)*
            $(#[$end_doc])* #[doc = concat!("In messages: ", $end_text)] $end,
        }

        impl TokenKind {
            /// Its name in messages.
            #[must_use]
            pub fn describe(self) -> &'static str {
                match self {
                    $(TokenKind::$kind => $text,)*
                    $(TokenKind::$keyword => $word,)*
                    TokenKind::$end => $end_text,
                }
            }
        }

        /// RAPID's keywords in upper case.
        pub const KEYWORDS: &[(&str, TokenKind)] = &[$(($word, TokenKind::$keyword),)*];

        #[expect(non_upper_case_globals, reason = "named as the kinds they stand for")]
        mod packed {
            $(pub(super) const $keyword: u64 = super::pack($word.as_bytes());)*
        }

        fn by_packed(word: u64) -> Option<TokenKind> {
            match word {
                $(packed::$keyword => Some(TokenKind::$keyword),)*
                _ => None,
            }
        }
    };
}

token_kinds! {
    kinds {
        /// Spaces, line ends, control characters, wide spaces.
        Whitespace = "white space",
        /// `! …` to the end of the line, without the line end.
        Comment = "a comment",
        /// Identifier that is not a keyword.
        Identifier = "a name",
        /// `1`, `.5`, `1E-3`, `0xFF` …
        Number = "a number",
        /// `"…"`
        String = "a string",
        /// `"…` up to the end of the line.
        UnclosedString = "a string without its closing quotation mark",
        /// `<SMT>`, `<EXP>` …
        Placeholder = "a placeholder",
        /// `%%%`
        HeaderMark = "'%%%'",
        /// A whole module in ABB's binary encoding.
        Encoded = "an encoded module",
        /// Bytes that start no token of RAPID.
        Unknown = "a character that RAPID does not have here",
        Semicolon = "';'",
        Comma = "','",
        Colon = "':'",
        Assign = "':='",
        Dot = "'.'",
        LeftParen = "'('",
        RightParen = "')'",
        LeftBracket = "'['",
        RightBracket = "']'",
        LeftBrace = "'{'",
        RightBrace = "'}'",
        Backslash = "'\\'",
        Question = "'?'",
        Bar = "'|'",
        Percent = "'%'",
        Plus = "'+'",
        Minus = "'-'",
        Star = "'*'",
        Slash = "'/'",
        Equal = "'='",
        NotEqual = "'<>'",
        Less = "'<'",
        LessEqual = "'<='",
        Greater = "'>'",
        GreaterEqual = "'>='",
    }
    keywords {
        Alias = "ALIAS",
        And = "AND",
        Backward = "BACKWARD",
        Case = "CASE",
        Connect = "CONNECT",
        Const = "CONST",
        Default = "DEFAULT",
        Div = "DIV",
        Do = "DO",
        Else = "ELSE",
        ElseIf = "ELSEIF",
        EndFor = "ENDFOR",
        EndFunc = "ENDFUNC",
        EndIf = "ENDIF",
        EndModule = "ENDMODULE",
        EndProc = "ENDPROC",
        EndRecord = "ENDRECORD",
        EndTest = "ENDTEST",
        EndTrap = "ENDTRAP",
        EndWhile = "ENDWHILE",
        Error = "ERROR",
        Exit = "EXIT",
        False = "FALSE",
        For = "FOR",
        From = "FROM",
        Func = "FUNC",
        Goto = "GOTO",
        If = "IF",
        InOut = "INOUT",
        Local = "LOCAL",
        Mod = "MOD",
        Module = "MODULE",
        Not = "NOT",
        Or = "OR",
        Pers = "PERS",
        Proc = "PROC",
        Raise = "RAISE",
        Record = "RECORD",
        Retry = "RETRY",
        Return = "RETURN",
        Step = "STEP",
        Task = "TASK",
        Test = "TEST",
        Then = "THEN",
        To = "TO",
        Trap = "TRAP",
        True = "TRUE",
        TryNext = "TRYNEXT",
        Undo = "UNDO",
        Var = "VAR",
        While = "WHILE",
        With = "WITH",
        Xor = "XOR",
    }
    /// The kind after the last token; no token has it.
    EndOfFile = "the end of the file",
}

/// Number of letters of the longest keywords (`ENDMODULE`, `ENDRECORD`).
const LONGEST_KEYWORD: usize = 9;

/// A word of up to 12 ASCII letters as one number, without case: 5 bits per letter.
const fn pack(word: &[u8]) -> u64 {
    let mut packed = 0;
    let mut i = 0;
    while i < word.len() {
        packed = packed << 5 | (word[i] & 0x1F) as u64;
        i += 1;
    }
    packed
}

impl TokenKind {
    /// The keyword that equals a word without regard to case.
    #[must_use]
    pub fn keyword(word: &[u8]) -> Option<TokenKind> {
        // Only letters: in five bits, `_` and digits would collide with letters.
        if !(2..=LONGEST_KEYWORD).contains(&word.len()) || !word.iter().all(u8::is_ascii_alphabetic)
        {
            return None;
        }
        by_packed(pack(word))
    }

    /// Whether the keyword ends a block of statements.
    #[must_use]
    pub fn closes_block(self) -> bool {
        matches!(
            self,
            TokenKind::EndIf
                | TokenKind::EndFor
                | TokenKind::EndWhile
                | TokenKind::EndTest
                | TokenKind::EndProc
                | TokenKind::EndFunc
                | TokenKind::EndTrap
                | TokenKind::EndRecord
                | TokenKind::EndModule
        )
    }

    /// White space or comment.
    #[must_use]
    pub fn is_trivia(self) -> bool {
        self <= TokenKind::Comment
    }

    /// A reserved word.
    #[must_use]
    pub fn is_keyword(self) -> bool {
        (TokenKind::Alias..=TokenKind::Xor).contains(&self)
    }
}

/// The tokens of a file; together they cover its bytes without gaps.
#[derive(Clone, Debug, Default)]
pub struct Tokens {
    kinds: Vec<TokenKind>,
    /// First byte of each token, and the end of the last.
    starts: Vec<u32>,
}

impl Tokens {
    pub(super) fn with_capacity(tokens: usize) -> Tokens {
        let mut starts = Vec::with_capacity(tokens + 1);
        starts.push(0);
        Tokens { kinds: Vec::with_capacity(tokens), starts }
    }

    pub(super) fn push(&mut self, kind: TokenKind, end: u32) {
        self.kinds.push(kind);
        self.starts.push(end);
    }

    /// Their number.
    #[must_use]
    pub fn count(&self) -> usize {
        self.kinds.len()
    }

    /// Kind of a token; past the last, `EndOfFile`.
    #[must_use]
    pub fn kind(&self, index: usize) -> TokenKind {
        self.kinds.get(index).copied().unwrap_or(TokenKind::EndOfFile)
    }

    /// Bytes of a token; past the last, the empty range at the end.
    #[must_use]
    pub fn range(&self, index: usize) -> Range<u32> {
        let end = self.starts.last().copied().unwrap_or(0);
        let start = self.starts.get(index).copied().unwrap_or(end);
        start..self.starts.get(index + 1).copied().unwrap_or(end)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keywords_are_found_in_any_case() {
        for (word, kind) in KEYWORDS {
            assert_eq!(TokenKind::keyword(word.as_bytes()), Some(*kind));
            assert_eq!(TokenKind::keyword(word.to_lowercase().as_bytes()), Some(*kind));
            assert_eq!(kind.describe(), *word);
        }
        for word in ["IFF", "I", "EN_IF", "ENDMODULES", "reg1"] {
            assert_eq!(TokenKind::keyword(word.as_bytes()), None);
        }
    }
}
