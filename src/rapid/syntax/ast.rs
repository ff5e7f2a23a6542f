//! Typed views of nodes. If the source has a syntax error, a part may be missing.

use super::node::NodeKind;
use super::token::TokenKind;
use super::tree::{Node, Token};

/// Declares views and the node kinds that each accepts.
macro_rules! views {
    ($($(#[$doc:meta])* $name:ident($($kind:ident)|+);)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        pub struct $name<'t>(
            /// The node itself.
            pub Node<'t>,
        );

        impl<'t> $name<'t> {
            /// The view of a node, if its kind fits.
            #[must_use]
            pub fn cast(node: Node<'t>) -> Option<Self> {
                matches!(node.kind(), $(NodeKind::$kind)|+).then_some(Self(node))
            }
        }
    )*};
}

views! {
    /// `MODULE … ENDMODULE`
    Module(Module);
    /// `VAR num a := 1;`
    Data(DataDeclaration);
    /// `PROC`, `FUNC` or `TRAP`
    Routine(ProcDeclaration | FuncDeclaration | TrapDeclaration);
    /// `num a`
    Parameter(Parameter);
    /// `MoveJ p, v, z, t;`
    Call(CallStatement);
    /// `IF`, compact or not
    If(IfStatement | CompactIf);
    /// `FOR … ENDFOR`
    For(ForStatement);
    /// `CASE …:`
    Case(CaseBranch);
    /// `\name := value` and the other named forms of an argument.
    Argument(NamedArgument | OptionalArgument | ConditionalArgument);
}

/// Whether a node is in the place of a value: an expression, a placeholder or an error.
#[must_use]
pub fn is_value(node: Node<'_>) -> bool {
    node.kind().is_expression() || matches!(node.kind(), NodeKind::Placeholder | NodeKind::Error)
}

/// Whether a node is an argument.
#[must_use]
pub fn is_argument(node: Node<'_>) -> bool {
    is_value(node) || Argument::cast(node).is_some()
}

impl<'t> Module<'t> {
    /// Its name.
    #[must_use]
    pub fn name(self) -> Option<Node<'t>> {
        self.0.child(NodeKind::Name)
    }

    /// `SYSMODULE` …, as written.
    pub fn attributes(self) -> impl Iterator<Item = Token<'t>> {
        self.0
            .child(NodeKind::ModuleAttributes)
            .into_iter()
            .flat_map(Node::own_tokens)
            .filter(|token| token.kind() == TokenKind::Identifier)
    }
}

impl<'t> Data<'t> {
    /// `LOCAL` or `TASK`.
    #[must_use]
    pub fn scope(self) -> Option<TokenKind> {
        scope(self.0)
    }

    /// `VAR`, `PERS` or `CONST`.
    #[must_use]
    pub fn keyword(self) -> Option<TokenKind> {
        self.0
            .own_tokens()
            .map(Token::kind)
            .find(|kind| matches!(kind, TokenKind::Var | TokenKind::Pers | TokenKind::Const))
    }

    /// Name of its type.
    #[must_use]
    pub fn type_name(self) -> Option<Node<'t>> {
        self.0.child(NodeKind::TypeName)
    }

    /// Its name.
    #[must_use]
    pub fn name(self) -> Option<Node<'t>> {
        self.0.child(NodeKind::Name)
    }

    /// Its array dimensions.
    pub fn dimensions(self) -> impl Iterator<Item = Node<'t>> {
        self.0.child(NodeKind::Dimensions).into_iter().flat_map(Node::children)
    }

    /// Its value.
    #[must_use]
    pub fn value(self) -> Option<Node<'t>> {
        self.0.own_token(TokenKind::Assign)?;
        self.0.children().filter(|child| is_value(*child)).last()
    }
}

impl<'t> Routine<'t> {
    /// `LOCAL`.
    #[must_use]
    pub fn scope(self) -> Option<TokenKind> {
        scope(self.0)
    }

    /// Its name.
    #[must_use]
    pub fn name(self) -> Option<Node<'t>> {
        self.0.child(NodeKind::Name)
    }

    /// Its parameters; optional ones that exclude each other form one group.
    pub fn parameter_groups(self) -> impl Iterator<Item = ParameterGroup<'t>> {
        self.0.child(NodeKind::Parameters).into_iter().flat_map(Node::children).map(ParameterGroup)
    }

    /// The data declared before its statements.
    pub fn data(self) -> impl Iterator<Item = Data<'t>> {
        self.0.children().filter_map(Data::cast)
    }

    /// Its handlers of a kind.
    pub fn handlers(self, kind: NodeKind) -> impl Iterator<Item = Node<'t>> {
        self.0.children().filter(move |child| child.kind() == kind)
    }
}

/// A parameter, or optional ones that exclude each other.
#[derive(Clone, Copy, Debug)]
pub struct ParameterGroup<'t>(Node<'t>);

impl<'t> ParameterGroup<'t> {
    /// `\…`
    #[must_use]
    pub fn is_optional(self) -> bool {
        self.0.kind() == NodeKind::OptionalParameters
    }

    /// The parameters.
    pub fn parameters(self) -> impl Iterator<Item = Parameter<'t>> {
        let alone = Parameter::cast(self.0);
        let children = self.0.children().filter_map(Parameter::cast);
        alone.into_iter().chain(children.filter(move |_| alone.is_none()))
    }
}

impl<'t> Parameter<'t> {
    /// `VAR`, `PERS` or `INOUT`.
    #[must_use]
    pub fn mode(self) -> Option<TokenKind> {
        self.0.own_tokens().next().map(Token::kind)
    }

    /// Name of its type.
    #[must_use]
    pub fn type_name(self) -> Option<Node<'t>> {
        self.0.child(NodeKind::TypeName)
    }

    /// Its name.
    #[must_use]
    pub fn name(self) -> Option<Node<'t>> {
        self.0.child(NodeKind::Name)
    }
}

impl<'t> Call<'t> {
    /// The name of the called procedure, unless it is bound late.
    #[must_use]
    pub fn name(self) -> Option<Node<'t>> {
        self.0.children().next().filter(|child| child.kind() == NodeKind::Name)
    }

    /// `%expr%`
    #[must_use]
    pub fn late_binding(self) -> Option<Node<'t>> {
        self.0.child(NodeKind::LateBinding)
    }

    /// Its arguments.
    pub fn arguments(self) -> impl Iterator<Item = Node<'t>> {
        self.0.children().skip(1).filter(|child| is_argument(*child))
    }
}

impl<'t> If<'t> {
    /// Its condition.
    #[must_use]
    pub fn condition(self) -> Option<Node<'t>> {
        self.0.children().find(|child| is_value(*child))
    }

    /// The statement of a compact IF.
    #[must_use]
    pub fn statement(self) -> Option<Node<'t>> {
        self.0.children().nth(1)
    }
}

impl<'t> For<'t> {
    /// Its loop variable.
    #[must_use]
    pub fn variable(self) -> Option<Node<'t>> {
        self.0.child(NodeKind::Name)
    }

    /// First and last value.
    #[must_use]
    pub fn bounds(self) -> Option<(Node<'t>, Node<'t>)> {
        let mut values = self.0.children().filter(|child| is_value(*child));
        Some((values.next()?, values.next()?))
    }

    /// Its step.
    #[must_use]
    pub fn step(self) -> Option<Node<'t>> {
        self.0.child(NodeKind::ForStep)?.children().next()
    }
}

impl<'t> Case<'t> {
    /// Its values.
    pub fn values(self) -> impl Iterator<Item = Node<'t>> {
        self.0.children().filter(|child| is_value(*child))
    }
}

impl<'t> Argument<'t> {
    /// Its name.
    #[must_use]
    pub fn name(self) -> Option<Node<'t>> {
        self.0.child(NodeKind::Name)
    }

    /// What follows `:=` or `?`.
    #[must_use]
    pub fn value(self) -> Option<Node<'t>> {
        self.0.children().nth(1)
    }
}

fn scope(node: Node<'_>) -> Option<TokenKind> {
    let first = node.own_tokens().next()?.kind();
    matches!(first, TokenKind::Local | TokenKind::Task).then_some(first)
}
