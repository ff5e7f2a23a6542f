//! The reserved words that begin statements.

/// A word and what is inserted for it, with places to fill in.
pub(super) const STATEMENTS: &[(&str, &str)] = &[
    ("IF", "IF ${1:condition} THEN\n\t$0\nENDIF"),
    ("ELSEIF", "ELSEIF ${1:condition} THEN\n\t$0"),
    ("ELSE", "ELSE\n\t$0"),
    ("ENDIF", "ENDIF"),
    ("FOR", "FOR ${1:i} FROM ${2:1} TO ${3:n} DO\n\t$0\nENDFOR"),
    ("ENDFOR", "ENDFOR"),
    ("WHILE", "WHILE ${1:condition} DO\n\t$0\nENDWHILE"),
    ("ENDWHILE", "ENDWHILE"),
    ("TEST", "TEST ${1:value}\nCASE ${2:1}:\n\t$0\nENDTEST"),
    ("CASE", "CASE ${1:value}:\n\t$0"),
    ("DEFAULT", "DEFAULT:\n\t$0"),
    ("ENDTEST", "ENDTEST"),
    ("GOTO", "GOTO ${1:label};"),
    ("RETURN", "RETURN $0;"),
    ("RAISE", "RAISE;"),
    ("EXIT", "EXIT;"),
    ("RETRY", "RETRY;"),
    ("TRYNEXT", "TRYNEXT;"),
    ("CONNECT", "CONNECT ${1:interrupt} WITH ${2:trap};"),
    ("VAR", "VAR ${1:num} ${2:name};"),
    ("CONST", "CONST ${1:num} ${2:name} := ${3:0};"),
    ("ERROR", "ERROR\n\t$0"),
    ("UNDO", "UNDO\n\t$0"),
    ("BACKWARD", "BACKWARD\n\t$0"),
    ("ENDPROC", "ENDPROC"),
    ("ENDFUNC", "ENDFUNC"),
    ("ENDTRAP", "ENDTRAP"),
];

/// The same for declarations of a module.
pub(super) const DECLARATIONS: &[(&str, &str)] = &[
    ("MODULE", "MODULE ${1:name}\n\t$0\nENDMODULE"),
    ("PROC", "PROC ${1:name}()\n\t$0\nENDPROC"),
    ("FUNC", "FUNC ${1:num} ${2:name}()\n\t$0\nENDFUNC"),
    ("TRAP", "TRAP ${1:name}\n\t$0\nENDTRAP"),
    ("RECORD", "RECORD ${1:name}\n\t${2:num} ${3:component};\nENDRECORD"),
    ("ALIAS", "ALIAS ${1:num} ${2:name};"),
    ("VAR", "VAR ${1:num} ${2:name};"),
    ("PERS", "PERS ${1:num} ${2:name} := ${3:0};"),
    ("CONST", "CONST ${1:num} ${2:name} := ${3:0};"),
];

/// Words that begin a value.
pub(super) const VALUES: &[&str] = &["TRUE", "FALSE", "NOT"];
