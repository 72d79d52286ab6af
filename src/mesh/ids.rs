//! Indices with a type, so that a patch is never taken for an element.

macro_rules! id {
    ($(#[$doc:meta])* $name:ident, $item:ident, $list:ident) => {
        $(#[$doc])*
        #[derive(
            Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize, serde::Deserialize,
        )]
        pub struct $name(pub u32);

        impl $name {
            /// The position in the list that it names an item of.
            pub fn index(self) -> usize {
                self.0 as usize
            }
        }

        impl std::ops::Index<$name> for super::Mesh {
            type Output = super::$item;
            fn index(&self, id: $name) -> &super::$item {
                &self.$list[id.index()]
            }
        }
    };
}

id! {
    /// Names a [`super::Patch`] of one mesh.
    PatchId, Patch, patches
}
id! {
    /// Names an [`super::Element`] of one mesh. Never dangles: elements are only ever added.
    ElementId, Element, elements
}
id! {
    /// Names a [`super::Vertex`] of one mesh. Never dangles: vertices are only ever added.
    VertexId, Vertex, vertices
}
