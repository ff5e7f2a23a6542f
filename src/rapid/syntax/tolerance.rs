//! Accepted deviations from the strict grammar.

/// Declares the tolerances and their productions.
macro_rules! tolerances {
    ($($(#[$doc:meta])* $tolerance:ident = $production:literal,)*) => {
        /// An accepted deviation from the grammar, which controllers or programmers produce.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum Tolerance {
            $($(#[$doc])* $tolerance,)*
        }

        impl Tolerance {
            /// All of them.
            pub const ALL: &[Tolerance] = &[$(Tolerance::$tolerance,)*];

            /// Its production in `grammar/tolerances.ebnf`.
            #[must_use]
            pub fn production(self) -> &'static str {
                match self { $(Tolerance::$tolerance => $production,)* }
            }
        }
    };
}

tolerances! {
    /// Prose or other text outside `MODULE … ENDMODULE`.
    TextOutsideModule = "text_outside_module",
    /// Declarations without a `MODULE` around them.
    DeclarationOutsideModule = "declaration_outside_module",
    /// Types, data and routines in an order other than this.
    DeclarationOrder = "declaration_order",
    /// A lone `;` where a declaration or a statement can stand.
    EmptyStatement = "empty_statement",
    /// Text other than version and language between the `%%%`.
    HeaderContents = "header_contents",
    /// `LOCAL VAR` or `TASK VAR` inside a routine.
    ScopeInRoutine = "scope_in_routine",
    /// A data declaration after a statement of its routine.
    DataBetweenStatements = "data_between_statements",
    /// `CONST` without a value.
    ConstWithoutValue = "const_without_value",
    /// `Proc(a, b);`: the arguments of a call in parentheses.
    ParenthesizedArguments = "parenthesized_arguments",
    /// `, \Opt`: a comma before an optional argument or parameter.
    CommaBeforeOptional = "comma_before_optional",
    /// `\Error`: an optional argument with the name of a keyword.
    KeywordAsArgument = "keyword_as_argument",
    /// `a*-1`: a sign after an operator.
    SignAfterOperator = "sign_after_operator",
    /// `a AND NOT b`: `NOT` neither first in its expression nor after `OR` or `XOR`.
    NotAfterOperator = "not_after_operator",
    /// `f(x).c`, `f(x){1}`: a component of the value of a function.
    ComponentOfCall = "component_of_call",
    /// `|\b`: the backslash repeated before an alternative parameter.
    BackslashInAlternative = "backslash_in_alternative",
    /// `REF num a`: a parameter with a mode that only built-in routines have.
    ReferenceParameter = "reference_parameter",
    /// `num a{3}`: a parameter with a size instead of `*`.
    ParameterWithSize = "parameter_with_size",
    /// `DEFAULT` that is not last in its `TEST`.
    DefaultNotLast = "default_not_last",
    /// Handlers in an order other than `BACKWARD`, `ERROR`, `UNDO`.
    HandlerOrder = "handler_order",
    /// Module attributes out of order, or repeated.
    AttributeOrder = "attribute_order",
}

/// A use of a tolerance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tolerated {
    /// Which.
    pub tolerance: Tolerance,
    /// First byte.
    pub start: u32,
    /// One past the last byte.
    pub end: u32,
}
