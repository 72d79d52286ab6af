//! Indices with a type each, so that a patch is never taken for an element.

/// An index into a list: a name, and it may be the items of which type, owner and field it names, for `owner[name]`.
macro_rules! id {
    ($(#[$doc:meta])* $name:ident $(: $item:ty, $list:ty, $field:ident)?) => {
        $(#[$doc])*
        #[derive(
            Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize, serde::Deserialize,
        )]
        pub struct $name(pub u32);

        impl $name {
            /// The position in the list that it names an item of.
            pub fn index(self) -> usize {
                self.0 as usize
            }
        }

        $(impl std::ops::Index<$name> for $list {
            type Output = $item;
            fn index(&self, id: $name) -> &$item {
                &self.$field[id.index()]
            }
        })?
    };
}

pub(crate) use id;
