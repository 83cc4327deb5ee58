//! Header and tables of a DXF file.

use std::fmt::Write as _;

use super::Writer;

impl Writer<'_> {
    pub(super) fn header(&mut self) {
        // $INSUNITS: the drawing's unit, 0 when CAD has no number for it
        let units = [
            (1e-3, 4),
            (1e-2, 5),
            (1.0, 6),
            (1e3, 7),
            (0.0254, 1),
            (0.3048, 2),
            (1e-6, 13),
            (0.9144, 10),
        ];
        let unit = self.unit();
        let code = units
            .iter()
            .find(|(size, _)| (size / unit - 1.0).abs() < 1e-9)
            .map_or(0, |(_, code)| *code);
        let imperial = matches!(code, 1 | 2 | 10);
        self.out.push_str(
            "  0\nSECTION\n  2\nHEADER\n  9\n$ACADVER\n  1\nAC1015\n  9\n$HANDSEED\n  5\nFFFFFF\n",
        );
        let _ = write!(
            self.out,
            "  9\n$INSUNITS\n 70\n{code}\n  9\n$MEASUREMENT\n 70\n{}\n",
            u8::from(!imperial)
        );
        self.out.push_str("  0\nENDSEC\n");
    }

    pub(super) fn tables(&mut self, layers: &[(String, u32)]) {
        let table = |out: &mut String, name: &str, handle: &str, count: usize| {
            let _ = write!(
                out,
                "  0\nTABLE\n  2\n{name}\n  5\n{handle}\n330\n0\n100\nAcDbSymbolTable\n 70\n{count}\n"
            );
        };
        self.out.push_str("  0\nSECTION\n  2\nTABLES\n");
        table(&mut self.out, "VPORT", "8", 0);
        self.out.push_str("  0\nENDTAB\n");
        table(&mut self.out, "LTYPE", "5", 3);
        for (handle, name) in [("14", "ByBlock"), ("15", "ByLayer"), ("16", "Continuous")] {
            let _ = write!(
                self.out,
                "  0\nLTYPE\n  5\n{handle}\n330\n5\n100\nAcDbSymbolTableRecord\n100\nAcDbLinetypeTableRecord\n  2\n{name}\n \
                 70\n0\n  3\n\n 72\n65\n 73\n0\n 40\n0.0\n"
            );
        }
        self.out.push_str("  0\nENDTAB\n");
        table(&mut self.out, "LAYER", "2", layers.len());
        for (name, rgb) in layers {
            self.handle += 1;
            let _ = write!(
                self.out,
                "  0\nLAYER\n  5\n{:X}\n330\n2\n100\nAcDbSymbolTableRecord\n100\nAcDbLayerTableRecord\n  2\n{name}\n 70\n0\n \
                 62\n{}\n  6\nContinuous\n370\n-3\n390\nF\n",
                self.handle,
                nearest_index(*rgb)
            );
        }
        self.out.push_str("  0\nENDTAB\n");
        table(&mut self.out, "STYLE", "3", 1);
        self.out.push_str(
            "  0\nSTYLE\n  5\n11\n330\n3\n100\nAcDbSymbolTableRecord\n100\nAcDbTextStyleTableRecord\n  2\nStandard\n 70\n0\n \
             40\n0.0\n 41\n1.0\n 50\n0.0\n 71\n0\n 42\n2.5\n  3\ntxt\n  4\n\n  0\nENDTAB\n",
        );
        table(&mut self.out, "VIEW", "6", 0);
        self.out.push_str("  0\nENDTAB\n");
        table(&mut self.out, "UCS", "7", 0);
        self.out.push_str("  0\nENDTAB\n");
        table(&mut self.out, "APPID", "9", 1);
        self.out.push_str(
            "  0\nAPPID\n  5\n12\n330\n9\n100\nAcDbSymbolTableRecord\n100\nAcDbRegAppTableRecord\n  2\nACAD\n 70\n0\n  \
             0\nENDTAB\n",
        );
        self.out.push_str("  0\nTABLE\n  2\nDIMSTYLE\n  5\nA\n330\n0\n100\nAcDbSymbolTable\n 70\n0\n100\nAcDbDimStyleTable\n  0\nENDTAB\n");
        table(&mut self.out, "BLOCK_RECORD", "1", 2);
        for (handle, name) in [("1F", "*Model_Space"), ("1B", "*Paper_Space")] {
            let _ = write!(
                self.out,
                "  0\nBLOCK_RECORD\n  5\n{handle}\n330\n1\n100\nAcDbSymbolTableRecord\n100\nAcDbBlockTableRecord\n  \
                 2\n{name}\n340\n0\n"
            );
        }
        self.out.push_str("  0\nENDTAB\n  0\nENDSEC\n");
    }
}

/// The basic AutoCAD colour (1 to 9) nearest to a colour.
fn nearest_index(rgb: u32) -> u8 {
    let basic = [
        0xFF0000,
        0xFFFF00,
        0x00FF00,
        0x00FFFF,
        0x0000FF,
        0xFF00FF,
        0x000000,
        0x808080,
        0xC0C0C0_u32,
    ];
    let channel = |v: u32, shift: u32| i64::from((v >> shift) & 255);
    let far = |a: u32| {
        [0, 8, 16]
            .map(|s| (channel(a, s) - channel(rgb, s)).pow(2))
            .iter()
            .sum::<i64>()
    };
    let nearest = (0..basic.len()).min_by_key(|&k| far(basic[k])).unwrap_or(6);
    nearest as u8 + 1
}
