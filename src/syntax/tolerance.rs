//! Deviations from the strict grammar that are accepted.

/// What is accepted although the grammar does not have it, because controllers
/// or the people who write for them produce it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Tolerance {
    /// Prose or other text outside `MODULE … ENDMODULE`.
    TextOutsideModule,
    /// Declarations of a file that has no `MODULE` around them.
    DeclarationOutsideModule,
    /// Types, data and routines in another order than this.
    DeclarationOrder,
    /// A lone `;` where a declaration or a statement can stand.
    EmptyStatement,
    /// Other text than version and language between the `%%%`.
    HeaderContents,
    /// `LOCAL VAR` or `TASK VAR` inside a routine.
    ScopeInRoutine,
    /// A data declaration elsewhere than first in its routine.
    DataBetweenStatements,
    /// `CONST` without a value.
    ConstWithoutValue,
    /// `Proc(a, b);`: the arguments of a call in parentheses.
    ParenthesizedArguments,
    /// `, \Opt`: a comma before an optional argument or parameter.
    CommaBeforeOptional,
    /// `\Error`: an optional argument named as a keyword.
    KeywordAsArgument,
    /// `a*-1`: a sign after an operator.
    SignAfterOperator,
    /// `a AND NOT b`: `NOT` elsewhere than first in its expression or behind
    /// `OR` and `XOR`.
    NotAfterOperator,
    /// `f(x).c`, `f(x){1}`: a component of the value of a function.
    ComponentOfCall,
    /// `|\b`: the backslash repeated before an alternative parameter.
    BackslashInAlternative,
    /// `DEFAULT` elsewhere than last in its `TEST`.
    DefaultNotLast,
    /// Handlers in another order than `BACKWARD`, `ERROR`, `UNDO`.
    HandlerOrder,
    /// Module attributes in another order than the fixed one, or twice.
    AttributeOrder,
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

impl Tolerance {
    /// All of them.
    pub const ALL: &[Tolerance] = &[
        Tolerance::TextOutsideModule,
        Tolerance::DeclarationOutsideModule,
        Tolerance::DeclarationOrder,
        Tolerance::EmptyStatement,
        Tolerance::HeaderContents,
        Tolerance::ScopeInRoutine,
        Tolerance::DataBetweenStatements,
        Tolerance::ConstWithoutValue,
        Tolerance::ParenthesizedArguments,
        Tolerance::CommaBeforeOptional,
        Tolerance::KeywordAsArgument,
        Tolerance::SignAfterOperator,
        Tolerance::NotAfterOperator,
        Tolerance::ComponentOfCall,
        Tolerance::BackslashInAlternative,
        Tolerance::DefaultNotLast,
        Tolerance::HandlerOrder,
        Tolerance::AttributeOrder,
    ];
}
