//! Deviations from the strict grammar that are accepted.

/// Declares the tolerances and the names of their productions.
macro_rules! tolerances {
    ($($(#[$doc:meta])* $tolerance:ident = $production:literal,)*) => {
        /// What is accepted although the grammar does not have it, because
        /// controllers or the people who write for them produce it.
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
    /// Declarations of a file that has no `MODULE` around them.
    DeclarationOutsideModule = "declaration_outside_module",
    /// Types, data and routines in another order than this.
    DeclarationOrder = "declaration_order",
    /// A lone `;` where a declaration or a statement can stand.
    EmptyStatement = "empty_statement",
    /// Other text than version and language between the `%%%`.
    HeaderContents = "header_contents",
    /// `LOCAL VAR` or `TASK VAR` inside a routine.
    ScopeInRoutine = "scope_in_routine",
    /// A data declaration elsewhere than first in its routine.
    DataBetweenStatements = "data_between_statements",
    /// `CONST` without a value.
    ConstWithoutValue = "const_without_value",
    /// `Proc(a, b);`: the arguments of a call in parentheses.
    ParenthesizedArguments = "parenthesized_arguments",
    /// `, \Opt`: a comma before an optional argument or parameter.
    CommaBeforeOptional = "comma_before_optional",
    /// `\Error`: an optional argument named as a keyword.
    KeywordAsArgument = "keyword_as_argument",
    /// `a*-1`: a sign after an operator.
    SignAfterOperator = "sign_after_operator",
    /// `a AND NOT b`: `NOT` elsewhere than first in its expression or behind
    /// `OR` and `XOR`.
    NotAfterOperator = "not_after_operator",
    /// `f(x).c`, `f(x){1}`: a component of the value of a function.
    ComponentOfCall = "component_of_call",
    /// `|\b`: the backslash repeated before an alternative parameter.
    BackslashInAlternative = "backslash_in_alternative",
    /// `REF num a`: a parameter whose mode is one of built-in routines only.
    ReferenceParameter = "reference_parameter",
    /// `num a{3}`: a parameter with a size where `*` should stand.
    ParameterWithSize = "parameter_with_size",
    /// `DEFAULT` elsewhere than last in its `TEST`.
    DefaultNotLast = "default_not_last",
    /// Handlers in another order than `BACKWARD`, `ERROR`, `UNDO`.
    HandlerOrder = "handler_order",
    /// Module attributes in another order than the fixed one, or twice.
    AttributeOrder = "attribute_order",
}

/// A tolerance and where it was used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tolerated {
    /// Which.
    pub tolerance: Tolerance,
    /// First byte.
    pub start: u32,
    /// One past the last byte.
    pub end: u32,
}
