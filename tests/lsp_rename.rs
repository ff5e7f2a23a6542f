//! Renaming in the editor: what is renamed, and what is refused.

#![cfg(feature = "lsp")]
#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod lsp_client;

use serde_json::json;

use lsp_client::{Client, Marked, Memory, Place, edited};

/// The files after a rename; unchanged ones are left out.
fn renamed(cell: &Marked, mark: u32, new: &str) -> Vec<(String, String)> {
    let mut client = cell.start();
    let edits = client.rename(cell.place(mark), new);
    edits
        .into_iter()
        .map(|(file, edits)| {
            let text = edited(&cell.text(&file), &edits);
            (file, text)
        })
        .collect()
}

fn refused(cell: &Marked, mark: u32, new: &str) -> String {
    cell.start().refusal("textDocument/rename", cell.place(mark).renaming(new))
}

const CELL: &[(&str, &str)] = &[
    (
        "Main.mod",
        "MODULE Main\n\
         CONST num <1>nTries := 3;\n\
         LOCAL VAR num <2>nCount;\n\
         PERS num nOther := 2;\n\
         PROC main()\n\
         <3>rPick <4>NTRIES \\<5>Fast;\n\
         <6>nCount := nTries + Main2;\n\
         ENDPROC\n\
         FUNC num Main2() RETURN nOther; ENDFUNC\n\
         ENDMODULE\n",
    ),
    (
        "Lib.sys",
        "MODULE Lib(SYSMODULE)\n\
         LOCAL VAR num nCount;\n\
         PROC <13>rPick(num nTries \\switch <15>Fast)\n\
         VAR num nLocal;\n\
         IF Present(Fast) nCount := nTries + nLocal;\n\
         %\"rPick\"% nTries;\n\
         MoveLSync p10, v100, fine, tool0, \"RPICK\";\n\
         TPWrite \"rPick\";\n\
         ENDPROC\n\
         PROC rUse() nCount := nOther + nTries; ENDPROC\n\
         CONST robtarget p10 := [[0,0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
         ENDMODULE\n",
    ),
];

#[test]
fn a_name_is_changed_in_its_scope_only() {
    let cell = Marked::new(CELL);
    let after = renamed(&cell, 1, "nMany");
    assert_eq!(after.len(), 2);
    let lib = &after[0].1;
    assert!(lib.contains("PROC rPick(num nTries") && lib.contains("nOther + nMany"), "{lib}");
    let main = &after[1].1;
    assert!(main.contains("CONST num nMany") && main.contains("rPick nMany \\Fast"), "{main}");
    // LOCAL data of one module.
    let after = renamed(&cell, 2, "nSeen");
    assert_eq!(after.len(), 1);
    assert_eq!(after[0].1.matches("nSeen").count(), 2);
    // A parameter is named in calls.
    let after = renamed(&cell, 5, "Quick");
    assert!(after[0].1.contains("\\switch Quick") && after[0].1.contains("Present(Quick)"));
    assert!(after[1].1.contains("\\Quick;"), "{}", after[1].1);
    // Another case only.
    let after = renamed(&cell, 2, "NCOUNT");
    assert!(after[0].1.contains("VAR num NCOUNT"), "{}", after[0].1);
}

/// Strings that call the procedure are changed, other strings are not.
#[test]
fn strings_that_call_a_procedure_are_renamed() {
    let after = renamed(&Marked::new(CELL), 3, "rGrip");
    let lib = &after[0].1;
    for text in ["PROC rGrip(", "%\"rGrip\"%", "tool0, \"rGrip\";", "TPWrite \"rPick\";"] {
        assert!(lib.contains(text), "{lib}");
    }
}

#[test]
fn impossible_names_are_refused_with_the_reason() {
    let cell = Marked::new(CELL);
    let long = "a".repeat(33);
    for (mark, new, reason) in [
        (1, "1x", "'1x' is no name: use letters, digits and _, with a letter first"),
        (1, "a b", "is no name"),
        (1, "_a", "is no name"),
        (1, "", "is no name"),
        (1, "a;b", "is no name"),
        (1, long.as_str(), "has 33 characters: a name of RAPID has at most 32"),
        (1, "endproc", "'endproc' is a reserved word"),
        (1, "movel", "'movel' is a name of RAPID or RobotWare"),
        (1, "robtarget", "is a name of RAPID"),
        (1, "v100", "is a name of RAPID"),
        (1, "tool0", "is a name of RAPID"),
        (1, "ERR_DIVZERO", "is a name of RAPID"),
        // In the same module, in another one, the name of a module.
        (1, "ncount", "'ncount' is declared at Main.mod:3"),
        (1, "rUse", "'rUse' is declared at Lib.sys:10"),
        (1, "Lib", "'Lib' is declared at Lib.sys:1"),
        (2, "main2", "'main2' is declared at Main.mod:9"),
        (15, "nLocal", "'nLocal' is declared at Lib.sys:4"),
        // The parameter would hide the datum of the module.
        (15, "nCount", "what stands at Lib.sys:5 would mean another declaration"),
        // The LOCAL name would hide the global one, which the module uses.
        (2, "rPick", "what stands at Main.mod:6 would mean another declaration"),
    ] {
        let message = refused(&cell, mark, new);
        assert!(message.contains(reason), "{new}: {message}");
    }
}

/// A name that is hidden already stays possible where nothing changes its meaning.
#[test]
fn a_name_that_only_hides_is_possible() {
    let cell = Marked::new(&[(
        "A.mod",
        "MODULE A\nVAR num <1>nA;\nPROC rA()\nVAR num nB;\nnB := 1;\nENDPROC\nPROC rB()\nnA := 1;\nENDPROC\nENDMODULE\n",
    )]);
    let after = renamed(&cell, 1, "nB");
    assert!(after[0].1.contains("VAR num nB;\nPROC rA()"), "{}", after[0].1);
}

#[test]
fn what_is_not_declared_here_is_refused() {
    let text = "MODULE M\nPROC main()\nMoveJ p10, v100, fine, tool0;\nEGMReset egm;\n%\"rX\"+NumToStr(1,0)%;\nENDPROC\nPROC rX1()\nENDPROC\nENDMODULE\n";
    let mut client = Client::start(Memory::new(&[("M.mod", text)]), &json!({}));
    let mut refuse = |word: &str, method: &str| {
        let place = Place::of("M.mod", text, text.find(word).unwrap());
        client.refusal(&format!("textDocument/{method}"), place.renaming("other"))
    };
    assert!(refuse("MoveJ", "prepareRename").contains("'MoveJ' belongs to RAPID"));
    assert!(refuse("v100", "rename").contains("'v100' belongs to RAPID"));
    assert!(refuse("p10", "rename").contains("no file of the workspace declares 'p10'"));
    assert!(refuse("main", "rename").contains("'main' starts the program"));
    assert!(refuse("ENDPROC", "prepareRename").contains("there is no name here"));
    let message = refuse("rX1", "rename");
    assert!(message.contains("'rX1' at M.mod:5 may mean it, too"), "{message}");
}

#[test]
fn preparing_tells_the_range_and_the_name() {
    let cell = Marked::new(CELL);
    let mut client = cell.start();
    let place = cell.place(4);
    let answer = client.at("prepareRename", place);
    assert_eq!(answer["placeholder"], "NTRIES");
    assert_eq!(answer["range"]["end"]["character"], place.character + 6);
}

/// A persistent is renamed in all tasks of the controller, and not to a name that one of them has.
#[test]
fn persistents_are_renamed_in_all_tasks() {
    let mut cell = Marked::new(&[
        ("A.mod", "MODULE A\nPERS num <1>nShared := 1;\nPERS num nMine := 1;\nENDMODULE\n"),
        (
            "B.mod",
            "MODULE B\nPERS num nShared := 1;\nPERS num nYours := 1;\nPROC main() nShared := 2; ENDPROC\nENDMODULE\n",
        ),
    ]);
    cell.memory.tasks = vec![vec![0], vec![1]];
    let after = renamed(&cell, 1, "nCommon");
    assert_eq!(after.len(), 2);
    assert_eq!(after[1].1.matches("nCommon").count(), 2);
    assert!(refused(&cell, 1, "nYours").contains("'nYours' is declared at B.mod:3"));
}

/// A file in another encoding gets the name in it, if it has the letters.
#[test]
fn the_encoding_of_a_file_limits_the_letters() {
    let bytes: Vec<u8> =
        "MODULE M\r\n! Größe für alle Öffnungen, später prüfen\r\nVAR num nÖ;\r\nENDMODULE\r\n"
            .chars()
            .map(|it| it as u8)
            .collect();
    let memory = Memory { files: vec![("M.mod".to_owned(), bytes)], ..Memory::default() };
    let mut client = Client::start(memory, &json!({}));
    let place = Place { file: "M.mod".to_owned(), line: 2, character: 9 };
    let edits = client.rename(&place, "nÄ");
    assert_eq!(edits["M.mod"][0]["range"]["start"]["character"], 8);
    assert_eq!(edits["M.mod"][0]["range"]["end"]["character"], 10);
    let message = client.refusal("textDocument/rename", place.renaming("nЖ"));
    assert!(message.contains("M.mod is windows-1252, which cannot hold 'nЖ'"), "{message}");
}

/// Components of values whose type is not known may be meant.
#[test]
fn a_component_of_an_unknown_value_is_doubtful() {
    let cell = Marked::new(&[(
        "M.mod",
        "MODULE M\nRECORD part num <1>weight; num <2>height; ENDRECORD\nPROC main()\nVAR part p;\np.height := gone.weight;\nENDPROC\nENDMODULE\n",
    )]);
    let message = refused(&cell, 1, "mass");
    assert!(message.contains("'weight' at M.mod:5 may mean it, too"), "{message}");
    let after = renamed(&cell, 2, "size");
    assert!(after[0].1.contains("p.size := gone.weight"), "{}", after[0].1);
}
