//! Node kinds: the productions of the grammar.

/// Declares the kinds and the names of their productions in `grammar/`.
macro_rules! node_kinds {
    ($($(#[$doc:meta])* $kind:ident = $production:literal,)*) => {
        /// Kind of a node of the tree: a production of `grammar/`, or an error.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        #[repr(u8)]
        pub enum NodeKind {
            $($(#[$doc])* $kind,)*
        }

        impl NodeKind {
            /// All kinds, for tests.
            #[cfg(feature = "internals")]
            pub const ALL: &[NodeKind] = &[$(NodeKind::$kind,)*];

            /// Its production in `grammar/`.
            #[must_use]
            pub fn production(self) -> &'static str {
                match self { $(NodeKind::$kind => $production,)* }
            }
        }
    };
}

node_kinds! {
    /// Tokens that fit no production, or (empty) a missing element.
    Error = "error",

    /// The whole file.
    File = "file",
    /// `%%% VERSION:1 LANGUAGE:ENGLISH %%%`
    Header = "header",
    /// `MODULE … ENDMODULE`
    Module = "module",
    /// `(SYSMODULE, …)`
    ModuleAttributes = "module_attributes",
    /// Text between or around modules.
    OutsideText = "outside_text",
    /// A module in ABB's binary encoding.
    EncodedModule = "encoded_module",

    /// `VAR num a := 1;`
    DataDeclaration = "data_declaration",
    /// `{2, 3}`
    Dimensions = "dimensions",
    /// `RECORD … ENDRECORD`
    RecordDeclaration = "record_declaration",
    /// `num x;` in a record.
    RecordComponent = "record_component",
    /// `ALIAS num level;`
    AliasDeclaration = "alias_declaration",
    /// Name of a type.
    TypeName = "type_name",
    /// A name in a declaration, or another name that is not a value.
    Name = "name",

    /// `PROC … ENDPROC`
    ProcDeclaration = "proc_declaration",
    /// `FUNC … ENDFUNC`
    FuncDeclaration = "func_declaration",
    /// `TRAP … ENDTRAP`
    TrapDeclaration = "trap_declaration",
    /// `(num a, \num b)`
    Parameters = "parameters",
    /// `num a`
    Parameter = "parameter",
    /// `\num a | num b`
    OptionalParameters = "optional_parameters",
    /// `{*, *}`
    OpenDimensions = "open_dimensions",
    /// Statements.
    Block = "block",
    /// `BACKWARD …`
    BackwardHandler = "backward_handler",
    /// `ERROR …`
    ErrorHandler = "error_handler",
    /// `(ERR_A, ERR_B)`
    ErrorNumbers = "error_numbers",
    /// `UNDO …`
    UndoHandler = "undo_handler",

    /// `a := b;`
    Assignment = "assignment",
    /// `MoveJ p, v, z, t;`
    CallStatement = "call_statement",
    /// `%expr%`
    LateBinding = "late_binding",
    /// `IF … THEN … ENDIF`
    IfStatement = "if_statement",
    /// `ELSEIF … THEN …`
    ElseIfBranch = "elseif_branch",
    /// `ELSE …`
    ElseBranch = "else_branch",
    /// `IF … statement`
    CompactIf = "compact_if",
    /// `FOR … ENDFOR`
    ForStatement = "for_statement",
    /// `STEP expr`
    ForStep = "for_step",
    /// `WHILE … ENDWHILE`
    WhileStatement = "while_statement",
    /// `TEST … ENDTEST`
    TestStatement = "test_statement",
    /// `CASE …:`
    CaseBranch = "case_branch",
    /// `DEFAULT:`
    DefaultBranch = "default_branch",
    /// `GOTO a;`
    GotoStatement = "goto_statement",
    /// `a:`
    LabelStatement = "label_statement",
    /// `RETURN …;`
    ReturnStatement = "return_statement",
    /// `RAISE …;`
    RaiseStatement = "raise_statement",
    /// `EXIT;`
    ExitStatement = "exit_statement",
    /// `RETRY;`
    RetryStatement = "retry_statement",
    /// `TRYNEXT;`
    TryNextStatement = "trynext_statement",
    /// `CONNECT a WITH b;`
    ConnectStatement = "connect_statement",
    /// `;`
    EmptyStatement = "empty_statement",
    /// A placeholder such as `<SMT>`.
    Placeholder = "placeholder",

    /// `name := expr` as an argument.
    NamedArgument = "named_argument",
    /// `\name := expr`, `\name`
    OptionalArgument = "optional_argument",
    /// `\name ? parameter`
    ConditionalArgument = "conditional_argument",
    /// `*` in place of a position.
    AnyPosition = "any_position",

    /// `1.5`
    NumberLiteral = "number_literal",
    /// `"a"`
    StringLiteral = "string_literal",
    /// `TRUE`
    BoolLiteral = "bool_literal",
    /// `a`
    Reference = "reference",
    /// `a.b`
    FieldAccess = "field_access",
    /// `a{1}`
    IndexAccess = "index_access",
    /// `f(a)`
    FunctionCall = "function_call",
    /// `[a, b]`
    Aggregate = "aggregate",
    /// `(a)`
    Parenthesized = "parenthesized",
    /// `NOT a`, `-a`
    UnaryExpression = "unary_expression",
    /// `a + b`
    BinaryExpression = "binary_expression",
}

impl NodeKind {
    /// Whether it stands in the place of a value: an expression, a placeholder or an error.
    #[must_use]
    pub fn is_value(self) -> bool {
        (NodeKind::AnyPosition..=NodeKind::BinaryExpression).contains(&self)
            || matches!(self, NodeKind::Placeholder | NodeKind::Error)
    }

    /// Whether it is an argument other than a bare value.
    #[must_use]
    pub fn is_named_argument(self) -> bool {
        (NodeKind::NamedArgument..=NodeKind::ConditionalArgument).contains(&self)
    }

    /// Whether it is the declaration of a routine.
    #[must_use]
    pub fn is_routine(self) -> bool {
        (NodeKind::ProcDeclaration..=NodeKind::TrapDeclaration).contains(&self)
    }

    /// Whether the production is a statement other than data, an empty one or a placeholder.
    #[must_use]
    pub fn is_statement(self) -> bool {
        matches!(
            self,
            NodeKind::Assignment
                | NodeKind::CallStatement
                | NodeKind::IfStatement
                | NodeKind::CompactIf
                | NodeKind::ForStatement
                | NodeKind::WhileStatement
                | NodeKind::TestStatement
                | NodeKind::GotoStatement
                | NodeKind::LabelStatement
                | NodeKind::ReturnStatement
                | NodeKind::RaiseStatement
                | NodeKind::ExitStatement
                | NodeKind::RetryStatement
                | NodeKind::TryNextStatement
                | NodeKind::ConnectStatement
        )
    }
}
